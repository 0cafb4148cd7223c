# SPDX-License-Identifier: MIT
"""Random scenes that mix everything, written in all formats and read back: each file is a closed manifold of as many
triangles, pieces and handles and of the volume that the mesh has.

Usage: random_formats.py COUNT SEED [NUMBER]. NUMBER is the only scene of the seed that is tried, and is kept in the
folder at hand. A scene of eight is made of cells that follow the shape, the others of equal cells; each has writers'
options of its own. Scenes that are nothing, or endless, say so and count as refused. What files are written of matters
here, not how: hulls of what is curved are rare, and scenes of cells that follow the shape small, as these take twenty
times as long as all the files do.
"""
import json
import os
import random
import subprocess
import sys
import tempfile

import cli

FILES = ["out." + kind for kind in ("obj", "ply", "stl", "off", "gltf", "glb", "drc", "3mf", "amf")]
WRITERS = {"--ascii": [], "--normals": ["vertex", "crease", "none"], "--up": ["z"], "--unit": ["cm", "m", "in", "none"],
           "--compress": ["meshopt", "draco", "meshopt-khr"], "--colors": ["none"]}
NAMES = ["lid", "a b", "<&>", "Größe", "\\U01F600", "A", "a", "%% ]", "x" * 60]
COLOURS = ['"red"', '"#12345678"', "[0.2, 0.4, 0.6, 0.5]", '"white"', '"goldenrod"']
DONE, AT_FAULT = 0, 1
STEP = 2**-14  # of the longest side: where Draco and meshoptimizer put vertices


def number(rng, least, most):
    return f"{rng.uniform(least, most):.{rng.choice([0, 1, 3, 6])}f}" if least * most <= 0 else \
        f"{max(rng.uniform(least, most), least):.{rng.choice([2, 3, 6])}f}"


def vector(rng, least, most):
    return "[" + ", ".join(number(rng, least, most) for _ in range(3)) + "]"


def figure(rng, depth):
    if depth == 0 or rng.random() < 0.5:
        return rng.choice([
            lambda: f"square([{number(rng, 2, 9)}, {number(rng, 2, 9)}]);",
            lambda: f"translate([6, 0]) circle({number(rng, 1, 5)});",
            lambda: f"circle({number(rng, 1, 5)}, $fn = {rng.randint(3, 9)});",
            lambda: f"polygon([[0, 0], [{number(rng, 3, 9)}, 0], [{number(rng, 2, 6)}, {number(rng, 2, 9)}], [1, 2]]);",
            lambda: f'text("{rng.choice("AgB8&")}", {number(rng, 5, 12)});',
        ])()
    words = rng.choice(["union()", "difference()", "intersection()", "hull()", f"offset({number(rng, 0.2, 1)})",
                        f"offset(delta = {number(rng, -0.3, 1)})", f"union(blend = {number(rng, 0.5, 2)})"])
    return words + " { " + " ".join(figure(rng, depth - 1) for _ in range(2)) + " }"


def leaf(rng):
    small, size = lambda: number(rng, 0.5, 2), lambda: number(rng, 3, 9)
    return rng.choice([
        lambda: f"sphere({size()});",
        lambda: f"cube([{size()}, {size()}, {size()}], center = {rng.choice(['true', 'false'])});",
        lambda: f"cube({size()}, round = {number(rng, 0.2, 1.2)});",
        lambda: f"cylinder(h = {size()}, r1 = {size()}, r2 = {small()});",
        lambda: f"cylinder(h = {size()}, r = {size()}, $fn = {rng.randint(3, 40)});",
        lambda: f"capsule([0, 0, 0], {vector(rng, 3, 9)}, {small()}, {number(rng, 1, 3)});",
        lambda: f"torus({size()}, {small()}, {rng.choice(['360', '120', '270'])});",
        lambda: f"ellipsoid([{size()}, {size()}, {number(rng, 2, 4)}]);",
        lambda: f"superellipsoid([{size()}, {size()}, {size()}], {number(rng, 1, 6)});",
        lambda: f"tube([[0, 0, 0], {vector(rng, 2, 6)}, {vector(rng, -6, 6)}, {vector(rng, -9, -4)}], {small()}, 3);",
        lambda: f"spline([[0, 0, 0], {vector(rng, 2, 6)}, {vector(rng, -6, -3)}], {small()});",
        lambda: f"linear_extrude({size()}) {figure(rng, 2)}",
        lambda: f"linear_extrude({size()}, twist = {number(rng, -90, 90)}, scale = {number(rng, 0.5, 1.5)}) {figure(rng, 1)}",
        lambda: f"rotate_extrude(angle = {rng.choice(['360', '100'])}) translate([12, 0]) {figure(rng, 1)}",
        lambda: f"polyhedron([[0,0,0], [{size()},0,0], [0,{size()},0], [0,0,{size()}]], [[0,1,2], [0,3,1], [0,2,3], [1,3,2]]);",
        lambda: f"intersection() {{ sphere({size()}); {rng.choice(['gyroid', 'schwarz_p', 'diamond'])}(6, {number(rng, 1, 2)}); }}",
        lambda: f"field(function (p) {size()} - norm(p) - 0.3 * sin(40 * p.x), bounds = [[-12, -12, -12], [12, 12, 12]]);",
        lambda: f"roof() {figure(rng, 0)}",
        lambda: f"sweep([[0, 0, 0], [14, 0, 0], {vector(rng, 12, 20)}], {rng.choice(['smooth = true', 'round = 2', 'twist = 40'])}) square({small()}, center = true);",
    ])()


def blend(rng):
    return rng.choice([
        lambda: "0", lambda: "0", lambda: number(rng, 0.5, 3), lambda: f"fillet({number(rng, 0.5, 2)})",
        lambda: f"{rng.choice(['chamfer', 'cosine', 'parabola', 'overblend', 'round'])}({number(rng, 0.5, 3)})",
        lambda: f"{rng.choice(['hyperbola', 'reciprocal'])}({number(rng, 0.1, 1)})",
        lambda: f"exterior({number(rng, 0.5, 2)})", lambda: f"interior({number(rng, 0.5, 2)})",
        lambda: f"ricci({number(rng, 1, 4)}, range = {number(rng, 1, 3)})",
        lambda: f"{rng.choice(['soft_sum', 'soft_set', 'perlin', 'arc_sharp'])}(range = {number(rng, 1, 3)})",
    ])().replace("round(", "round(r = ")


def solid(rng, depth):
    if depth == 0 or rng.random() < 0.25:
        return leaf(rng)
    if rng.random() < 0.02:
        return "hull() { " + leaf(rng) + " " + leaf(rng) + " }"
    joins = [f"union(blend = {blend(rng)})", f"difference(blend = {blend(rng)})", f"intersection(blend = {blend(rng)})",
             "union()", "difference()"]
    around = [f"translate({vector(rng, -6, 6)})", f"rotate({vector(rng, -180, 180)})", f"mirror([1, {number(rng, -2, 2)}, 1])",
              f"scale([{number(rng, 0.6, 2)}, 1, {number(rng, 0.6, 2)}])", f"color({rng.choice(COLOURS)})",
              f"material({number(rng, 0.01, 0.9)}, {number(rng, 0.1, 0.9)})", f"offset3d({number(rng, -0.2, 0.6)})",
              f"shell({number(rng, 0.8, 2)})", f"twist({number(rng, -5, 5)})", f"repeat([20, 0, 0], [{rng.randint(1, 3)}, 1, 1])",
              f"resize([{number(rng, 5, 12)}, 0, 0], auto = true)"]
    words, most = (rng.choice(joins), 3) if rng.random() < 0.6 else (rng.choice(around), 1)
    return words + " { " + " ".join(solid(rng, depth - 1) for _ in range(rng.randint(min(2, most), most))) + " }"


def scene(rng, deepest, most):
    """Solids, in parts or not; the whole somewhere, large or small."""
    around = rng.choice(["", "", "", "scale(1e-3) ", "scale(300) ", "translate([1000, -500, 20]) "])
    return "".join(around + (f'part("{rng.choice(NAMES)}") ' if rng.random() < 0.4 else "") + solid(rng, rng.randint(1, deepest)) +
                   "\n" for _ in range(rng.randint(1, most)))


def settings_of(rng, number):
    """How the scene is meshed, and what writers may be asked for."""
    words = ["-r", str(rng.randint(8, 32))] if number % 8 else ["--quality", "draft"]
    for option, values in WRITERS.items():
        if rng.random() < 0.5:
            words += [option, rng.choice(values)] if values else [option]
    if "draco" not in words and rng.random() < 0.5:  # which has no place for them
        words += ["--uv", rng.choice(["box", "cylinder"])]
    return words


def loss(name, settings, mesh):
    """How far the file's volume may be off: no vertex lies more than a step off, and STL has floats."""
    low, high = mesh["bounds"]
    step = max(max(map(abs, low + high)) * 2**-22, 1e-12)
    if name == "out.drc" or name in ("out.gltf", "out.glb") and "--compress" in settings:
        step += max(b - a for a, b in zip(low, high)) * STEP
    return mesh["area"] * step


def enlarged(name, settings):
    """AMF has no centimetres, they are ten millimetres there."""
    return 1000 if name == "out.amf" and "cm" in settings else 1


def tells_of_touching(messages, file):
    """A reader of STL joins the corners of parts that touch: then no edge is open, but some have four triangles."""
    return f"{file['name']}: warning W0514: " in messages and not file["manifold"] and not file["boundary_edges"] \
        and file["nonmanifold_edges"] + file["nonmanifold_vertices"] > 0


def differences(stats, settings, messages):
    """What the files have that the mesh has not, and what was said of it in vain."""
    mesh = stats["mesh"]
    faults = [] if mesh["manifold"] and mesh["triangles"] else ["the mesh is no closed manifold"]
    if [file["name"] for file in stats["files"]] != FILES:
        faults.append(f"{len(stats['files'])} files were looked at")
    for file in stats["files"]:
        keys = ["triangles", "components", "genus"]
        if file["format"] == "stl" and "out.stl: warning W0514" in messages:
            if not tells_of_touching(messages, file):
                faults.append("out.stl: parts touch, says W0514, and the file has nothing of it")
            keys = ["triangles"]
        elif not file["manifold"]:
            faults.append(f"{file['name']}: no closed manifold")
        for key in keys:
            if file.get(key) != mesh.get(key):
                faults.append(f"{file['name']}: {key} {file.get(key)}, not {mesh.get(key)}")
        if abs(file["volume"] / enlarged(file["name"], settings) - mesh["volume"]) > loss(file["name"], settings, mesh):
            faults.append(f"{file['name']}: volume {file['volume']}, not {mesh['volume']}")
    return faults


def tried(text, settings, folder):
    """(status, what is wrong, whether parts touch)."""
    with open(os.path.join(folder, "scene.txt"), "w", encoding="utf-8") as file:
        file.write(text)
    outputs = [word for name in FILES for word in ("-o", name)]
    command = [cli.PROGRAM, "scene.txt", *settings, *outputs, "--stats-full", "--stats=stats.json", "--timeout", "60", "-j", "1", "--no-sync"]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600, check=False)
    if result.returncode != DONE:
        # E0505: too fine for a format's steps, as a solid of a thousand units off is for Draco's
        told = "error" in result.stderr and result.returncode == AT_FAULT or "E0902" in result.stderr or "E0505" in result.stderr
        return result.returncode, [] if told else [f"exit status {result.returncode}", result.stderr], False
    with open(os.path.join(folder, "stats.json"), encoding="utf-8") as file:
        return DONE, differences(json.load(file), settings, result.stderr), "W0514" in result.stderr


def tried_number(seed, number, folder):
    """The same, of one scene of a seed; what is wrong is told."""
    rng = random.Random(f"{seed} {number}")
    text, settings = scene(rng, *((3, 3) if number % 8 else (1, 2))), settings_of(rng, number)
    status, faults, touching = tried(text, settings, folder)
    if faults:
        print(f"scene {number} of seed {seed}, {' '.join(settings)}:\n{text}  " + "\n  ".join(faults), flush=True)
    return status != DONE, bool(faults), touching


def main():
    count, seed = int(sys.argv[1]), sys.argv[2]
    if len(sys.argv) > 3:
        return int(tried_number(seed, int(sys.argv[3]), ".")[1])
    with tempfile.TemporaryDirectory() as folder:
        tries = [tried_number(seed, i, folder) for i in range(count)]
    refused, bad, touching = (sum(column) for column in zip(*tries))
    print(f"{count} scenes, {count - refused} written in {len(FILES)} formats and read back ({touching} with parts that touch), "
          f"{refused} refused, {bad} at fault")
    return 1 if bad or refused * 2 > count else 0


if __name__ == "__main__":
    sys.exit(main())
