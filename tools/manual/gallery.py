#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the gallery of the literature's figures: scenes/papers/README.md, the pages of docs/papers and docs/pictures/papers.

    python3 tools/manual/gallery.py CSGMESH             makes what is out of date
    python3 tools/manual/gallery.py CSGMESH --all       makes everything
    python3 tools/manual/gallery.py --check             exit status 1 when page, scenes and pictures disagree
    python3 tools/manual/gallery.py CSGMESH --measure   exit status 1 when a mesh has other figures than the page

The pages are written by hand but for what stands between these lines:

    <!-- figure NAME "what is to be seen" OPTIONS OF csgmesh render -->
    <!-- end figure -->

NAME is a scene beside the page, or scene/detail for another picture of it. In between go the picture, for a scene also one of its
mesh, the command, and the mesh's figures, with the head of the SHA-256 of the scene's text and the line above.

A detail may be a row of pictures: each `--each "TITLE: OPTIONS"` adds one, with these options after the others.
"""
import glob
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
PAGES = [os.path.join(ROOT, "scenes", "papers", "README.md"),
         *sorted(glob.glob(os.path.join(ROOT, "docs", "papers", "*.md")))]
FOLDER = os.path.join(ROOT, "docs", "pictures", "papers")
OTHERS = {"nguyen.png"}  # of docs/evaluations.md
BLOCK = re.compile(r'^<!-- figure (\S+) "([^"]*)" ?(.*?) ?-->\n(.*?)^<!-- end figure -->\n', re.M | re.S)
MOST_BYTES = 60_000
COARSE = 72  # cells along a mesh whose triangles are to be seen


class Figure:
    """One block of a page."""

    def __init__(self, match, page):
        self.name, self.alt, options, self.body = match.groups()
        self.scene, _, self.detail = self.name.partition("/")
        self.folder = os.path.dirname(page)
        self.path = os.path.join(self.folder, self.scene + ".txt")
        self.options, self.row = self.read_options(shlex.split(options))
        self.head = match.group(0).split("\n", 1)[0] + "\n"

    @staticmethod
    def read_options(words):
        """What all pictures have, and of each picture of a row its title and what it has besides."""
        common, row = [], []
        words = iter(words)
        for word in words:
            if word == "--each":
                title, _, rest = next(words).partition(": ")
                row.append((title, shlex.split(rest)))
            else:
                common.append(word)
        return common, row

    def pictures(self):
        """The traced picture and, for a scene, that of its mesh; or those of a row."""
        if self.row:
            return [f"{self.scene}-{self.detail}-{i + 1}.png" for i in range(len(self.row))]
        if self.detail:
            return [f"{self.scene}-{self.detail}.png"]
        return [f"{self.scene}.png", f"{self.scene}-mesh.png"]

    def drawn(self):
        """The pictures that are traced from the field, each with its options."""
        if self.row:
            return [(name, [*self.options, *own]) for name, (_, own) in zip(self.pictures(), self.row)]
        return [(self.pictures()[0], self.options)]

    def place(self, path):
        """A path of the repository as the page names it."""
        return os.path.relpath(os.path.join(ROOT, path), self.folder).replace(os.sep, "/")

    def text(self):
        with open(self.path, encoding="utf-8") as file:
            return file.read()

    def state(self):
        text = re.sub(r"^//! normal .*\n", "", self.text(), flags=re.M)  # of no picture, of no figure here
        return hashlib.sha256((text + self.head).encode()).hexdigest()[:12]

    def is_made(self):
        return f"<!-- made of {self.state()} -->" in self.body

    def resolution(self):
        found = re.search(r"^//! resolution (\d+)", self.text(), re.M)
        return found.group(1) if found else "128"


def run(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def measures(program, figure):
    """One line of the mesh's figures."""
    mesh = json.loads(run(program, figure.path, "-r", figure.resolution(), "--stats", "-q"))["mesh"]
    faults = sum(mesh[key] for key in ("boundary_edges", "nonmanifold_edges", "misoriented_edges",
                                       "nonmanifold_vertices"))
    if faults:
        raise SystemExit(f"{figure.scene}: the mesh is no closed manifold")
    size = [b - a for a, b in zip(*mesh["bounds"])]
    pieces = f"{mesh['components']} piece{'s' if mesh['components'] > 1 else ''}"
    return (f"Mesh at `-r {figure.resolution()}`: {mesh['triangles']:,} triangles, closed manifold, "
            f"{pieces}, Euler characteristic {mesh['euler']}, volume {mesh['volume']:.5g}, "
            f"size {size[0]:.4g} x {size[1]:.4g} x {size[2]:.4g}.").replace(",", " ", mesh["triangles"] >= 1000)


def draw_mesh(program, figure, out):
    options = list(figure.options)
    if "--size" in options:
        at = options.index("--size")
        width, height = options[at + 1].split("x")
        options[at + 1] = f"{int(width) * 2 // 3}x{int(height) * 2 // 3}"
    options = [o for o in options if o not in ("--no-shadows", "--no-occlusion")]
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "mesh.glb")
        cells = max(COARSE, int(figure.resolution()) // 4)
        run(program, figure.path, "-r", str(cells), "-o", mesh, "-q")
        run(program, "render", mesh, "-o", out, "--wireframe", "-q", *options)


def command_of(figure, name, options):
    return " ".join(shlex.quote(word) for word in
                    ["csgmesh", "render", os.path.relpath(figure.path, ROOT), "-o", name, *options])


def body_of(program, figure):
    names = figure.pictures()
    links = [f"![{figure.alt}]({figure.place('docs/pictures/papers/' + name)})" for name in names]
    lines = []
    if figure.row:
        titles = [title for title, _ in figure.row]
        links = [link.replace("![", f"![{title}: ", 1) for title, link in zip(titles, links)]
        lines += ["| " + " | ".join(titles) + " |", "|" + " --- |" * len(titles), "| " + " | ".join(links) + " |", "",
                  "The first: `" + command_of(figure, *figure.drawn()[0]) + "`"]
    elif figure.detail:
        lines += [links[0], "", f"`{command_of(figure, *figure.drawn()[0])}`"]
    else:
        mesh_link = links[1].replace("![", "![The mesh, coarse: ", 1)
        lines += [f"| [{figure.scene}.txt]({figure.scene}.txt) | its mesh, coarse |", "| --- | --- |",
                  f"| {links[0]} | {mesh_link} |", "", f"`{command_of(figure, *figure.drawn()[0])}`", "",
                  measures(program, figure)]
    return "\n".join(lines + ["", f"<!-- made of {figure.state()} -->"]) + "\n"


def draw(program, figure, folder):
    """Traces the figure's pictures into a folder."""
    for name, options in figure.drawn():
        run(program, "render", figure.path, "-o", os.path.join(folder, name), "-q", *options)


def make(program, figure):
    draw(program, figure, FOLDER)
    if not figure.detail:
        draw_mesh(program, figure, os.path.join(FOLDER, figure.pictures()[1]))
    print(f"{figure.name}: " + ", ".join(f"{os.path.getsize(os.path.join(FOLDER, name)) / 1000:.0f} kB"
                                         for name in figure.pictures()))
    return figure.head + body_of(program, figure) + "<!-- end figure -->\n"


def figures_of(page, text):
    return [Figure(match, page) for match in BLOCK.finditer(text)]


def all_figures():
    """The figures of all pages as they stand."""
    figures = []
    for page in PAGES:
        with open(page, encoding="utf-8") as file:
            figures += figures_of(page, file.read())
    return figures


def faults_of(figures):
    """What does not agree, as lines."""
    scenes = {path for page in PAGES for path in glob.glob(os.path.join(os.path.dirname(page), "*.txt"))}
    for path in sorted(scenes - {figure.path for figure in figures}):
        yield f"{os.path.relpath(path, ROOT)} is on no page"
    have = set(os.listdir(FOLDER))
    wanted = {name for figure in figures for name in figure.pictures()}
    for name in sorted(have - wanted - OTHERS):
        yield f"docs/pictures/papers/{name} is left over"
    for figure in figures:
        if figure.path not in scenes:
            yield f"{os.path.relpath(figure.path, ROOT)} does not exist"
        elif not figure.is_made():
            yield f"{figure.name}: the page is older than the scene or its options"
        for name in figure.pictures():
            if name not in have:
                yield f"docs/pictures/papers/{name} is missing"
            elif os.path.getsize(os.path.join(FOLDER, name)) > MOST_BYTES:
                yield f"docs/pictures/papers/{name} has more than {MOST_BYTES} bytes"


def measure_all(program, figures):
    for figure in figures:
        if not figure.detail and (line := measures(program, figure)) not in figure.body:
            yield f"{figure.scene}: now {line}"


def report(faults):
    faults = list(faults)
    for fault in faults:
        print(fault)
    if faults:
        print("python3 tools/manual/gallery.py CSGMESH makes the page and its pictures")
    return 1 if faults else 0


def renew(program, page, everything):
    """Makes the figures of a page that are out of date."""
    def renewed(match):
        figure = Figure(match, page)
        here = all(os.path.exists(os.path.join(FOLDER, name)) for name in figure.pictures())
        return match.group(0) if figure.is_made() and here and not everything else make(program, figure)

    with open(page, encoding="utf-8") as file:
        new = BLOCK.sub(renewed, file.read())
    with open(page, "w", encoding="utf-8") as file:
        file.write(new)


def main():
    options = [word for word in sys.argv[1:] if word.startswith("--")]
    programs = [word for word in sys.argv[1:] if not word.startswith("--")]
    if "--check" in options:
        return report(faults_of(all_figures()))
    program = os.path.abspath(programs[0])
    if "--measure" in options:
        return report(measure_all(program, all_figures()))
    os.makedirs(FOLDER, exist_ok=True)
    for page in PAGES:
        renew(program, page, "--all" in options)
    figures = all_figures()
    for name in set(os.listdir(FOLDER)) - {name for f in figures for name in f.pictures()} - OTHERS:
        os.remove(os.path.join(FOLDER, name))
    return report(faults_of(figures))


if __name__ == "__main__":
    sys.exit(main())
