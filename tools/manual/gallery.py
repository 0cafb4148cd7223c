#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the gallery of the literature's figures: scenes/papers/README.md and docs/pictures/papers.

    python3 tools/manual/gallery.py CSGMESH             makes what is out of date
    python3 tools/manual/gallery.py CSGMESH --all       makes everything
    python3 tools/manual/gallery.py --check             exit status 1 when page, scenes and pictures disagree
    python3 tools/manual/gallery.py CSGMESH --measure   exit status 1 when a mesh has other figures than the page

The page is written by hand but for what stands between these lines:

    <!-- figure NAME "what is to be seen" OPTIONS OF csgmesh render -->
    <!-- end figure -->

NAME is a scene of scenes/papers, or scene/detail for another picture of it. In between go the picture, for a scene also one of its
mesh, the command, and the mesh's figures, with the head of the SHA-256 of the scene's text and the line above.
"""
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
SCENES = os.path.join(ROOT, "scenes", "papers")
PAGE = os.path.join(SCENES, "README.md")
FOLDER = os.path.join(ROOT, "docs", "pictures", "papers")
OTHERS = {"nguyen.png"}  # of docs/evaluations.md
BLOCK = re.compile(r'^<!-- figure (\S+) "([^"]*)" ?(.*?) ?-->\n(.*?)^<!-- end figure -->\n', re.M | re.S)
MOST_BYTES = 60_000
COARSE = 72  # cells along a mesh whose triangles are to be seen


class Figure:
    """One block of the page."""

    def __init__(self, match):
        self.name, self.alt, options, self.body = match.groups()
        self.scene, _, self.detail = self.name.partition("/")
        self.path = os.path.join(SCENES, self.scene + ".txt")
        self.options = shlex.split(options)
        self.head = match.group(0).split("\n", 1)[0] + "\n"

    def pictures(self):
        """The traced picture and, for a scene, that of its mesh."""
        if self.detail:
            return [f"{self.scene}-{self.detail}.png"]
        return [f"{self.scene}.png", f"{self.scene}-mesh.png"]

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


def body_of(program, figure):
    command = " ".join(shlex.quote(word) for word in
                       ["csgmesh", "render", f"scenes/papers/{figure.scene}.txt", "-o", figure.pictures()[0],
                        *figure.options])
    links = [f"![{figure.alt}](../../docs/pictures/papers/{name})" for name in figure.pictures()]
    lines = []
    if figure.detail:
        lines += [links[0], "", f"`{command}`"]
    else:
        mesh_link = links[1].replace("![", "![The mesh, coarse: ", 1)
        lines += [f"| [{figure.scene}.txt]({figure.scene}.txt) | its mesh, coarse |", "| --- | --- |",
                  f"| {links[0]} | {mesh_link} |", "", f"`{command}`", "", measures(program, figure)]
    return "\n".join(lines + ["", f"<!-- made of {figure.state()} -->"]) + "\n"


def make(program, figure):
    out = os.path.join(FOLDER, figure.pictures()[0])
    run(program, "render", figure.path, "-o", out, "-q", *figure.options)
    if not figure.detail:
        draw_mesh(program, figure, os.path.join(FOLDER, figure.pictures()[1]))
    print(f"{figure.name}: " + ", ".join(f"{os.path.getsize(os.path.join(FOLDER, name)) / 1000:.0f} kB"
                                         for name in figure.pictures()))
    return figure.head + body_of(program, figure) + "<!-- end figure -->\n"


def faults_of(figures):
    """What does not agree, as lines."""
    scenes = {name[:-4] for name in os.listdir(SCENES) if name.endswith(".txt")}
    shown = {figure.scene for figure in figures if not figure.detail}
    for name in sorted(scenes - shown):
        yield f"{name}.txt is not in scenes/papers/README.md"
    have = set(os.listdir(FOLDER))
    wanted = {name for figure in figures for name in figure.pictures()}
    for name in sorted(have - wanted - OTHERS):
        yield f"docs/pictures/papers/{name} is left over"
    for figure in figures:
        if figure.scene not in scenes:
            yield f"{figure.scene}.txt does not exist"
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


def main():
    with open(PAGE, encoding="utf-8") as file:
        old = file.read()
    figures = [Figure(match) for match in BLOCK.finditer(old)]
    options = [word for word in sys.argv[1:] if word.startswith("--")]
    programs = [word for word in sys.argv[1:] if not word.startswith("--")]
    if "--check" in options:
        return report(faults_of(figures))
    program = os.path.abspath(programs[0])
    if "--measure" in options:
        return report(measure_all(program, figures))
    os.makedirs(FOLDER, exist_ok=True)

    def renew(match):
        figure = Figure(match)
        here = all(os.path.exists(os.path.join(FOLDER, name)) for name in figure.pictures())
        return match.group(0) if figure.is_made() and here and "--all" not in options else make(program, figure)

    new = BLOCK.sub(renew, old)
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(new)
    figures = [Figure(match) for match in BLOCK.finditer(new)]
    for name in set(os.listdir(FOLDER)) - {name for f in figures for name in f.pictures()} - OTHERS:
        os.remove(os.path.join(FOLDER, name))
    return report(faults_of(figures))


if __name__ == "__main__":
    sys.exit(main())
