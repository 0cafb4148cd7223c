# SPDX-License-Identifier: MIT
"""Every scene here is the same solid to csgmesh as to OpenSCAD 2021.01.

Compared are volume, area, bounds and the number of components. What OpenSCAD makes of the scenes is
kept in goldens.csv, so the quick run needs csgmesh only; it has a coarser lattice and tolerances to
match. --fine: a fine lattice, volume and area within 0.5 %, bounds within a cell. --exact: with
--facets=exact, so that all solids are polyhedra, and volumes within 1e-4. --openscad: the goldens
are what the installed OpenSCAD makes (exit status 77, a skip, where none is installed). --write:
goldens.csv is written anew. --every N: of every N-th scene. More arguments are the names of the scenes to run.

Marching cubes cut off sharp edges, which takes about a quarter of a cell of area from each unit of
their length, and leave crumbs of a very acute one. So what differs at one resolution is tried at the
next; a difference of solids stays.

A scene may say, in a comment, `// components: not compared, the reason`; likewise for area, and for
--exact as a whole.
"""
import array
import concurrent.futures
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "openscad", "solids")
GOLDENS = os.path.join(HERE, "goldens.csv")
PROGRAM = os.environ.get("CSGMESH")
FIELDS = ["scene", "volume", "area", "components", "x0", "y0", "z0", "x1", "y1", "z1"]
# With sanitizers, which are after other faults, from a lattice on that is seldom fine enough.
COARSE = [32] if os.environ.get("CSGMESH_SANITIZED") == "1" else []
QUICK = {"resolutions": [*COARSE, 64, 128, 256], "volume": 0.01, "area": 0.03, "cells": 1.5}
FINE = {"resolutions": [256, 512, 1024], "volume": 0.005, "area": 0.005, "cells": 1}
EXACT = {**FINE, "resolutions": [256, 512, 1024, 2048], "volume": 1e-4,
         "options": ["--facets=exact"]}


def names():
    return sorted(name[:-5] for name in os.listdir(HERE) if name.endswith(".scad"))


def source(name):
    with open(os.path.join(HERE, name + ".scad"), encoding="utf-8") as file:
        return file.read()


def triangles_of(path):
    """Corners of the triangles of a binary STL file, as rows of nine floats."""
    with open(path, "rb") as file:
        data = file.read()
    count = int.from_bytes(data[80:84], "little")
    assert len(data) == 84 + 50 * count, "not a binary STL file"
    for i in range(count):
        yield array.array("f", data[84 + 50 * i + 12:84 + 50 * i + 48])


def components_of(triangles):
    """Pieces of the surface, joined by common corners."""
    parent = {}

    def root(corner):
        while parent.setdefault(corner, corner) != corner:
            parent[corner] = parent[parent[corner]]
            corner = parent[corner]
        return corner

    for t in triangles:
        corners = [root(tuple(t[k:k + 3])) for k in (0, 3, 6)]
        parent[corners[0]] = parent[corners[1]] = corners[2]
    return sum(root(corner) == corner for corner in list(parent))


def measure(path):
    """What goldens.csv has of a mesh."""
    triangles = list(triangles_of(path))
    low = [min(min(t[k::3]) for t in triangles) for k in range(3)]
    high = [max(max(t[k::3]) for t in triangles) for k in range(3)]
    volume = area = 0.0
    for t in triangles:
        a, b, c = ([x - o for x, o in zip(t[k:k + 3], low)] for k in (0, 3, 6))
        u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        area += sum(x * x for x in normal) ** 0.5 / 2
        volume += sum(x * y for x, y in zip(a, normal)) / 6
    return {"volume": volume, "area": area, "components": components_of(triangles),
            "bounds": [low, high]}


def openscad_facts(name):
    """(facts or None, what was said)"""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "mesh.stl")
        result = subprocess.run(["openscad", "-q", "--export-format", "binstl", "-o", out,
                                 os.path.join(HERE, name + ".scad")], capture_output=True,
                                timeout=3000, check=False)
        said = result.stderr.decode("utf-8", "replace")
        return (measure(out) if result.returncode == 0 and os.path.exists(out) else None), said


def csgmesh_facts(name, resolution, options=()):
    """(facts or None, what was said)"""
    result = subprocess.run([PROGRAM, "info", "--json", "-r", str(resolution), *options,
                             os.path.join(HERE, name + ".scad")], capture_output=True, timeout=600,
                            check=False)
    said = result.stderr.decode("utf-8", "replace")
    if result.returncode != 0:
        return None, said
    facts = json.loads(result.stdout)
    return {**facts["mesh"], "cell": facts["cell_size"]}, said


def read_goldens():
    with open(GOLDENS, encoding="utf-8", newline="") as file:
        return {row["scene"]: {"volume": float(row["volume"]), "area": float(row["area"]),
                               "components": int(row["components"]),
                               "bounds": [[float(row[k]) for k in FIELDS[4:7]],
                                          [float(row[k]) for k in FIELDS[7:10]]]}
                for row in csv.DictReader(file)}


def write_goldens(goldens):
    with open(GOLDENS, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(FIELDS)
        for name, facts in sorted(goldens.items()):
            numbers = [facts["volume"], facts["area"], facts["components"], *sum(facts["bounds"], [])]
            out.writerow([name] + [f"{x:.7g}" for x in numbers])


def differences(ours, theirs, limits):
    """What differs: the kind of it, and a line that says it."""
    found = {}
    for key in ("volume", "area"):
        ratio = ours[key] / theirs[key] - 1
        if abs(ratio) > limits[key]:
            found[key] = f"{ours[key]:.6g}, of OpenSCAD {theirs[key]:.6g} ({100 * ratio:+.3f} %)"
    worst = max(abs(a - b) for a, b in zip(sum(ours["bounds"], []), sum(theirs["bounds"], [])))
    if worst > limits["cells"] * ours["cell"]:
        found["bounds"] = (f"{ours['bounds']}, of OpenSCAD {theirs['bounds']}: "
                           f"{worst / ours['cell']:.2f} cells apart")
    if ours["components"] != theirs["components"]:
        found["components"] = f"{ours['components']}, of OpenSCAD {theirs['components']}"
    return found


def faults_of(name, theirs, limits):
    """What differs at every resolution that has to be tried, as lines."""
    left = set(theirs)
    for key in theirs:
        if f"// {key}: not compared" in source(name):
            left.remove(key)
    for resolution in limits["resolutions"]:
        ours, said = csgmesh_facts(name, resolution, limits.get("options", ()))
        if not ours:
            return ["not meshed\n" + said]
        if any(ours[key] for key in ("boundary_edges", "nonmanifold_edges", "misoriented_edges")):
            return ["not closed, or not a manifold"]
        found = differences(ours, theirs, limits)
        left &= set(found)
        if not left:
            break
    return [f"{key} {found[key]}" for key in sorted(left)]


def report(name, faults):
    print(f"{'FAIL' if faults else 'ok  '} {name}", flush=True)
    for fault in faults:
        print("     " + fault.strip().replace("\n", "\n     "), flush=True)


def same(a, b):
    """Are these the same numbers, but for the digits that are kept?"""
    pairs = zip([a["volume"], a["area"], *sum(a["bounds"], [])],
                [b["volume"], b["area"], *sum(b["bounds"], [])])
    size = max(map(abs, sum(b["bounds"], [])))
    return a["components"] == b["components"] and all(
        abs(x - y) <= 1e-4 * max(abs(y), size) for x, y in pairs)


def check(chosen, limits):
    goldens, bad = read_goldens(), 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        def run(name):
            return name, faults_of(name, goldens[name], limits) if name in goldens else ["no golden"]
        for name, faults in pool.map(run, chosen):
            bad += bool(faults)
            report(name, faults)
    for name in sorted(set(goldens) - set(names())):
        report(name, ["a golden without a scene"])
        bad += 1
    return 1 if bad or not chosen else 0


def check_openscad(chosen, write):
    if not shutil.which("openscad"):
        print("openscad is not installed: skipped")
        return 77
    goldens, bad = (read_goldens() if os.path.exists(GOLDENS) else {}), 0
    for name in chosen:
        theirs, said = openscad_facts(name)
        if not theirs:
            faults = ["OpenSCAD has no solid\n" + said]
        elif write:
            faults, goldens[name] = [], theirs
            write_goldens(goldens)
        else:
            kept = name in goldens and same(theirs, goldens[name])
            faults = [] if kept else [f"goldens.csv has other numbers than {theirs}"]
        bad += bool(faults)
        report(name, faults)
    return 1 if bad else 0


def main(arguments):
    step = 1
    if "--every" in arguments:
        place = arguments.index("--every")
        step = int(arguments[place + 1])
        arguments = arguments[:place] + arguments[place + 2:]
    chosen = [a for a in arguments if not a.startswith("-")] or names()[::step]
    if "--openscad" in arguments or "--write" in arguments:
        return check_openscad(chosen, "--write" in arguments)
    limits = {"--fine": FINE, "--exact": EXACT}
    if "--exact" in arguments:
        chosen = [name for name in chosen if "// --exact: not compared" not in source(name)]
    return check(chosen, next((limits[a] for a in arguments if a in limits), QUICK))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
