# SPDX-License-Identifier: MIT
"""dump --csg: what OpenSCAD reads is the solid that was dumped.

Every scene of tests/data/openscad/solids, and those below that only csgmesh can read, come back as
the same solid when csgmesh reads the dump: volume and bounds. --openscad: so they do when OpenSCAD
reads it (exit status 77, a skip, where it is not installed). --every N: of every N-th scene. What
OpenSCAD has no words for is one error, with its place.
"""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "openscad", "solids")
PROGRAM = os.environ.get("CSGMESH")
OURS = {
    "ball": "sphere(3);",
    "ellipsoid": "ellipsoid([1, 2, 3]);",
    "rounded_box": "translate([1, 2, 3]) cube([4, 5, 6], round = 1);",
    "pill": "cube([4, 4, 9], round = 2);",
    "rounded_cylinder": "cylinder(h = 5, r1 = 3, r2 = 2, round = 0.5);",
    "capsule": "capsule([0, 0, 0], [3, 4, 5], 1, 2);",
    "torus": "rotate([10, 20, 30]) torus(5, 1);",
    "arc": "torus(5, 1, angle = 100);",
    "half_space": "intersection() { rotate([5, 6, 7]) plane([1, 1, 0], 1); sphere(3); }",
    "cut_by_half_space": "difference() { translate([9, 0, 0]) cube(4); plane([-1, 0, 0], -11); }",
    "slab": "intersection() { cube(9); slab(2); }",
    "half_a_ring": "rotate_extrude(angle = 200) translate([3, 0]) square([1, 2]);",
    "quarter_ring": "rotate_extrude(angle = 90) translate([3, 0]) circle(1);",
    "twisted": "linear_extrude(5, twist = 70) square([3, 1]);",
    "twisted_centre": "linear_extrude(5, twist = -70, center = true) translate([1, 0]) square(2);",
    "rounded_plate": "linear_extrude(2) square([5, 4], round = 1);",
    "grown": "minkowski() { cube([2, 3, 4]); sphere(1); }",
    "cut": "linear_extrude(1) projection(cut = true) rotate([10, 20, 30]) cube(4, center = true);",
    "outline": "linear_extrude(3) offset(1) square(3);",
    "inline": "linear_extrude(3) offset(-1) square(5);",
    "mirrored": "mirror([1, 2, 3]) scale([1, 2, 0.5]) color(\"red\", 0.5) translate([1, 0, 0]) cylinder(3, 2, 1);",
    "looks": "part(\"a */ b\") material(0.3, 0.1) color(\"teal\") cube(1); part(\"b\") translate([3, 0, 0]) cube(2);",
    "figures": "difference(mixed = true) { sphere(4); circle(1); }",
}
NO_WORDS = {
    "union(blend = 1) { cube(3); sphere(2); }": "blends",
    "difference(blend = chamfer(1)) { cube(3); sphere(2); }": "blends",
    "field(function (p) 1 - norm(p));": "solids by a formula",
    "combine(function (a, b) (a + b) / 2) { cube(3); sphere(2); }": "solids by a formula",
    "soft() torus(3, 1);": "soft solids",
    "tube([[0, 0, 0], [5, 0, 0], [5, 5, 0]], 1, degree = 2);": "tubes along curves",
    "superellipsoid(3, 4);": "superellipsoids",
    "bend(9) cube([9, 1, 1], center = true);": "bent solids",
    "twist(9) translate([1, 0, 0]) cube([9, 1, 1], center = true);": "twisted solids",
    "offset3d(1) difference() { cube(3); sphere(2); }": "offsets of solids",
}


def run(*arguments, text=None):
    done = subprocess.run([PROGRAM, *arguments], input=text, capture_output=True, timeout=300, check=False)
    return done.returncode, done.stdout, done.stderr.decode("utf-8", "replace")


def dump(path, text=None):
    return run("dump", "--csg", "-q", "--facets=exact", path, text=text)


def facts(path, text=None):
    """(volume, bounds) or what was said."""
    status, out, said = run("info", "--json", "-q", "-r", "40", "--facets=exact", path, text=text)
    if status:
        return said
    mesh = json.loads(out)["mesh"]
    return mesh["volume"], sum(mesh["bounds"], [])


def volume_of_off(text):
    """(volume, bounds) of what OpenSCAD wrote."""
    numbers = text.split()
    corners, faces = int(numbers[1]), int(numbers[2])
    values = [float(n) for n in numbers[4:4 + 3 * corners]]
    points = [values[3 * i:3 * i + 3] for i in range(corners)]
    six, at = 0.0, 4 + 3 * corners
    for _ in range(faces):
        count = int(numbers[at])
        face = [points[int(n)] for n in numbers[at + 1:at + 1 + count]]
        for b, c in zip(face[1:], face[2:]):
            a = face[0]
            six += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                    + a[2] * (b[0] * c[1] - b[1] * c[0]))
        at += 1 + count
    return six / 6, [min(p[i] for p in points) for i in range(3)] + [max(p[i] for p in points) for i in range(3)]


class TooSlow(Exception):
    """OpenSCAD takes long, which says nothing of the text."""


def by_openscad(openscad, text):
    with tempfile.TemporaryDirectory() as folder:
        tree, out = os.path.join(folder, "t.csg"), os.path.join(folder, "t.off")
        with open(tree, "wb") as file:
            file.write(text)
        try:
            done = subprocess.run([openscad, "-q", "-o", out, tree], capture_output=True, timeout=30, check=False)
        except subprocess.TimeoutExpired as late:
            raise TooSlow from late
        if done.returncode:
            return done.stderr.decode("utf-8", "replace")
        with open(out, encoding="utf-8") as file:
            text = file.read()
        # colours of faces follow their corners
        lines = text.split("\n")
        kept = [" ".join(line.split()[:1 + int(line.split()[0])]) if len(line.split()) > 4 and i > 1 and
                line.split()[0].isdigit() else line for i, line in enumerate(lines)]
        return volume_of_off("\n".join(kept)), done.stderr.decode("utf-8", "replace")


def differ(a, b, share):
    size = max(a[1][i + 3] - a[1][i] for i in range(3))
    if abs(a[0] - b[0]) > share * max(abs(a[0]), abs(b[0])):
        return f"volume {a[0]}, {b[0]}"
    if any(abs(x - y) > share * size for x, y in zip(a[1], b[1])):
        return f"bounds {a[1]}, {b[1]}"
    return None


def goldens():
    with open(os.path.join(HERE, "goldens.csv"), encoding="utf-8", newline="") as file:
        return {row["scene"]: (float(row["volume"]), [float(row[k]) for k in ("x0", "y0", "z0", "x1", "y1", "z1")])
                for row in csv.DictReader(file)}


def scenes(every):
    names = sorted(name for name in os.listdir(HERE) if name.endswith(".scad"))[::every]
    for name in names:
        yield name[:-5], os.path.join(HERE, name), None
    for name, text in OURS.items():
        yield name, "-", text.encode()


def fault_of(name, path, text, openscad, kept):
    status, tree, said = dump(path, text)
    if status:
        return f"not dumped: {said}"
    if not openscad:
        source, again = facts(path, text), facts("-", tree)
        if isinstance(source, str) or isinstance(again, str):
            return None if source == again or (isinstance(source, str) and isinstance(again, str)) else f"{source} {again}"
        return differ(source, again, 0.02 if text else 1e-3)
    answer = by_openscad(openscad, tree)
    if isinstance(answer, str):
        return f"OpenSCAD refuses it: {answer}"
    if "WARNING" in answer[1] or "ERROR" in answer[1]:
        return f"OpenSCAD says {answer[1]}"
    wanted = facts(path, text) if text else kept.get(name)
    if not wanted or isinstance(wanted, str):
        return f"no golden: {wanted}"
    return differ(wanted, answer[0], 0.02 if text else 2e-3)


def refusals():
    for text, word in NO_WORDS.items():
        status, out, said = dump("-", text.encode())
        wanted = f"error E0346: OpenSCAD has no {word}: the scene cannot be written for it"
        if status == 0 or out or wanted not in said or not re.search(r"^-?:?.*:1:\d+: error", said, re.M):
            yield f"{text}: {said}"


def main():
    openscad = shutil.which("openscad") if "--openscad" in sys.argv else None
    if "--openscad" in sys.argv and not openscad:
        print("openscad is not installed: skipped")
        return 77
    every = int(sys.argv[sys.argv.index("--every") + 1]) if "--every" in sys.argv else 1
    kept, bad = goldens(), 0
    for name, path, text in scenes(every):
        try:
            fault = fault_of(name, path, text, openscad, kept)
        except TooSlow:
            print(f"{name}: OpenSCAD takes more than 30 s, not compared")
            continue
        bad += fault is not None
        if fault:
            print(f"FAIL {name}: {fault.strip()}")
    for fault in refusals():
        bad += 1
        print("FAIL " + fault)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
