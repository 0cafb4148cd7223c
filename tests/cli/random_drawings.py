# SPDX-License-Identifier: MIT
"""Random flat scenes as drawings: qpdf finds no fault in the PDF, and SVG, DXF and PDF hold the same layers of the
same areas.

Usage: random_drawings.py COUNT SEED; 77 where qpdf (Debian package qpdf) is not installed.
"""
import random
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import cli

SVG = "{http://www.w3.org/2000/svg}"
SKIPPED = 77
NAMES = ["lid", "a b", "<&>", "(()", "\\\\)", "Größe", "\\U01F600", "A", "a", "x" * 300, "\\u200F", "%% ]"]
COLOURS = ['"red"', '"#12345678"', "[0.2, 0.4, 0.6, 0.5]", '"white"']


def number(rng, least, most):
    return f"{rng.uniform(least, most):.{rng.choice([0, 1, 3, 6])}f}"


def polygon(rng):
    """Random points, so mostly a loop that crosses itself."""
    return "polygon([" + ", ".join(f"[{number(rng, -9, 9)}, {number(rng, -9, 9)}]"
                                   for _ in range(rng.randint(3, 9))) + "]);"


def leaf(rng):
    return rng.choice([
        lambda: f"square([{number(rng, 1, 20)}, {number(rng, 1, 20)}], center = true);",
        lambda: f"circle({number(rng, 1, 9)});",
        lambda: f"circle({number(rng, 1, 9)}, $fn = {rng.randint(3, 9)});",
        lambda: polygon(rng),
        lambda: f'text("{rng.choice("AgB8%&")}", {number(rng, 3, 12)});',
        lambda: f"projection() rotate([{number(rng, 0, 90)}, 20, 0]) cube({number(rng, 1, 9)});",
        lambda: f"projection(cut = true) translate([0, 0, {number(rng, -2, 2)}]) sphere({number(rng, 3, 9)});",
    ])()


def figure(rng, depth):
    """A figure, or several; some of them are empty."""
    if depth == 0 or rng.random() < 0.15:
        return leaf(rng)
    words = rng.choice([
        f"union(blend = {number(rng, 1, 4)})", "union()", "difference()", "difference()", "intersection()", "hull()",
        f"offset({number(rng, -1, 2)})", f"offset(delta = {number(rng, -1, 2)}, chamfer = true)",
        f"translate([{number(rng, -30, 30)}, {number(rng, -30, 30)}])", f"rotate({number(rng, -180, 180)})",
        f"mirror([1, {number(rng, -2, 2)}])", f"scale([{number(rng, 1, 3)}, {number(rng, 1, 2)}])",
        f"color({rng.choice(COLOURS)})",
    ])
    return words + " { " + " ".join(figure(rng, depth - 1) for _ in range(rng.randint(1, 3))) + " }"


def scene(rng):
    """One to four figures, each in a part of its own or not; the whole somewhere, large or small."""
    figures = [(f'part("{rng.choice(NAMES)}") ' if rng.random() < 0.4 else "") + figure(rng, rng.randint(1, 3))
               for _ in range(rng.randint(1, 4))]
    around = rng.choice(["", "", "scale(1e-3) ", "scale(300) ", "translate([1e5, -1e4]) "])
    return "".join(around + one + "\n" for one in figures)


def area_of(loops):
    """Of closed loops of points, those of holes the other way round."""
    return abs(sum(a[0] * b[1] - b[0] * a[1]
                   for loop in loops for a, b in zip(loop, loop[1:] + loop[:1])) / 2)


def areas_of_svg(data):
    paths = [group.find(f"{SVG}path").get("d") for group in xml.fromstring(data).findall(f"{SVG}g")]
    return [area_of([[tuple(map(float, p.split())) for p in re.split("[ML]", loop) if p.strip()]
                     for loop in path.replace("\n", "").split("Z")]) for path in paths]


def areas_of_pdf(data):
    """The content stream is as the writer wrote it, not compressed: layers of loops of `x y m` and `x y l`."""
    content = data.split(b"stream\n", 1)[1].split(b"endstream", 1)[0].decode("ascii")
    areas = []
    for layer in content.split(" BDC\n")[1:]:
        loops = []
        for line in layer.split("\n"):
            words = line.split()
            if words[-1:] == ["m"]:
                loops.append([])
            if words[-1:] in (["m"], ["l"]):
                loops[-1].append((float(words[0]), float(words[1])))
        areas.append(area_of(loops))
    return areas


def areas_of_dxf(data):
    lines = data.decode("ascii").split("\n")
    layers, loop, layer = {}, None, None
    entity = None
    pairs = list(zip(lines[::2], lines[1::2]))
    for code, value in pairs:
        code = int(code)
        if code == 0:
            entity = value
            if entity == "POLYLINE":
                loop, layer = [], None
            elif entity == "VERTEX":
                loop.append([0.0, 0.0])
            elif entity == "SEQEND":
                layers.setdefault(layer, []).append([tuple(p) for p in loop])
        elif entity == "POLYLINE" and code == 8:
            layer = value
        elif entity == "VERTEX" and code in (10, 20):
            loop[-1][code // 10 - 1] = float(value)
    return [area_of(loops) for loops in layers.values()]


class Drawing(cli.CliTest):
    def runTest(self):
        count, seed = OPTIONS
        drawn = 0
        for i in range(count):
            rng = random.Random(f"{seed} {i}")
            text = scene(rng)
            with self.subTest(seed=seed, number=i, scene=text):
                drawn += self.draw(text)
        print(f"{drawn} of {count} scenes are drawn, the others are empty")
        self.assertGreater(drawn, count // 2)

    def draw(self, text):
        self.write("scene.scad", text)
        outputs = [part for name in ("svg", "dxf", "pdf") for part in ("-o", "a." + name)]
        result = self.run_in("scene.scad", *outputs)
        self.assert_clean(result)
        if result.returncode == 1 and "nothing to draw" in result.stderr:
            return 0
        self.assert_status(result, 0)
        done = subprocess.run(["qpdf", "--check", "a.pdf"], cwd=self.folder, check=False, capture_output=True,
                              timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, b""), done.stdout)
        svg, pdf, dxf = areas_of_svg(self.read("a.svg")), areas_of_pdf(self.read("a.pdf")), areas_of_dxf(self.read("a.dxf"))
        self.assertEqual((len(pdf), len(dxf)), (len(svg), len(svg)))
        for wanted, *others in zip(svg, pdf, dxf):
            for area in others:
                self.assertAlmostEqual(area, wanted, delta=1e-4 * wanted)
        return 1


if __name__ == "__main__":
    if not shutil.which("qpdf"):
        print("skipped: there is no qpdf here (Debian package qpdf)")
        sys.exit(SKIPPED)
    OPTIONS = tuple(map(int, sys.argv[1:3]))
    sys.argv[1:] = []
    cli.unittest.main()
