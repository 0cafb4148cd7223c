#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The pictures of docs/hard-cases.md: every scene of scenes/hard as it is meshed, whole and near the hard place.

    python3 tools/manual/hard.py CSGMESH [NAME...]    makes them (needs Pillow)
    python3 tools/manual/hard.py --check              exit status 1 where page, scenes and pictures do not agree
"""
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
SCENES = os.path.join(ROOT, "scenes", "hard")
PAGE = os.path.join(ROOT, "docs", "hard-cases.md")
OUT = os.path.join(ROOT, "docs", "pictures", "hard")
SIZE, LARGEST, FAR = (330, 260), 60000, 30

# Scene: view of both pictures, centre and half the size of what the second takes in.
VIEWS = {
    "ball_in_a_ball": ("75,15", (8, 0, 0), 2),
    "between_the_points": ("35,40", (2.1, -1.9, 4.1), 1.2),
    "comb": ("20,30", (12, 2, 6), 2.5),
    "cone_on_its_tip": ("30,10", (0, 0, 0), 1),
    "coplanar_difference": ("30,35", (10, 8, 6), 5),
    "coplanar_union": ("-20,35", (13, 4, 4), 4),
    "crossed_logs": ("30,8", (0, 0, 0), 2),
    "cubes_at_a_corner": ("20,15", (0, 0, 0), 1.5),
    "cubes_at_an_edge": ("35,35", (0, 0, 10), 1.5),
    "cut_a_billionth_short": ("30,50", (8, 5, 4), 5),
    "double_cone": ("20,10", (0, 0, 10), 2),
    "faces_a_billionth_apart": ("-60,25", (2, 2, 5), 1.5),
    "hairline": ("30,10", (10, 0, 5), 1),
    "hole_as_wide_as_the_plate": ("15,45", (0, 5, 1), 2.5),
    "nearly_parallel_planes": ("-8,20", (0, -5, 5), 3),
    "needle": ("30,15", (0, 0, 31), 3),
    "on_the_lattice": ("35,40", (2, -2, 4), 1.2),
    "pyramid_of_16_sides": ("20,35", (0, 0, 7.6), 1),
    "rod_in_a_bore": ("60,55", (5.5, 0, 8), 2.2),
    "sphere_on_a_plate": ("30,4", (0, 0, 0), 2),
    "spheres_touching": ("10,20", (0, 0, 0), 1.2),
    "touching_cubes": ("30,25", (5, 5, 10), 2),
    "viviani": ("70,25", (7, 0, 0), 4),
    "wedge_of_one_degree": ("20,25", (4, 3, 0), 4),
}


def names():
    return sorted(name[:-4] for name in os.listdir(SCENES) if name.endswith(".txt"))


def mesh(program, name, out):
    path = os.path.join(SCENES, name + ".txt")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    cells = re.search(r"^//! resolution (\d+)", text, re.M).group(1)
    options = re.search(r"^//! options (.*)", text, re.M)
    subprocess.run([program, path, "-q", "-r", cells, *(options.group(1).split() if options else []), "-o", out],
                   check=True)


def draw(program, file, view, near, out):
    """Whole, or near a place: through a long lens, from outside the solid."""
    command = [program, "render", file, "-q", "--wireframe", "--shading", "flat", f"--view={view}",
               "--size", "%dx%d" % SIZE, "-o", out]
    if near:
        at, half = near
        frame = [c - FAR for c in at] + [c + FAR for c in at]
        command += [f"--frame={','.join(map(str, frame))}", "--zoom", str(FAR / half)]
    subprocess.run(command, check=True)


def make(program, name):
    from PIL import Image
    view, at, half = VIEWS[name]
    sheet = Image.new("RGB", (2 * SIZE[0], SIZE[1]), "white")
    with tempfile.TemporaryDirectory() as folder:
        file, picture = os.path.join(folder, "m.ply"), os.path.join(folder, "p.png")
        mesh(program, name, file)
        for column, what in enumerate((None, (at, half))):
            draw(program, file, view, what, picture)
            sheet.paste(Image.open(picture).convert("RGB"), (column * SIZE[0], 0))
    sheet.convert("P", palette=Image.ADAPTIVE, colors=32).save(os.path.join(OUT, name + ".png"), optimize=True)


def faults():
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    for name in names():
        if name not in VIEWS:
            yield f"{name}: no view in tools/manual/hard.py"
        for link in (f"(../scenes/hard/{name}.txt)", f"(pictures/hard/{name}.png)"):
            if page.count(link) != 1:
                yield f"docs/hard-cases.md: one {link} is wanted"
        picture = os.path.join(OUT, name + ".png")
        if not os.path.exists(picture) or os.path.getsize(picture) > LARGEST:
            yield f"{picture}: missing, or larger than {LARGEST} bytes"
    for name in sorted(set(VIEWS) - set(names())):
        yield f"{name}: no such scene"


def main():
    if sys.argv[1] == "--check":
        found = list(faults())
        print("\n".join(found) or "page, scenes and pictures agree")
        return 1 if found else 0
    os.makedirs(OUT, exist_ok=True)
    for name in sys.argv[2:] or names():
        make(sys.argv[1], name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
