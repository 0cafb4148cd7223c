# SPDX-License-Identifier: MIT
"""Random scenes that mix everything, written in all formats and read back: each file is a closed manifold of as many
triangles, pieces and handles and of the volume that the mesh has.

Usage: random_formats.py COUNT SEED. A scene of two is made of cells that follow the shape, the other of equal cells.
Scenes that are nothing, or endless, say so and count as refused.
"""
import json
import os
import random
import subprocess
import sys
import tempfile

import cli

KINDS = ["obj", "ply", "stl", "off", "gltf", "glb", "drc", "3mf", "amf"]
NAMES = ["lid", "a b", "<&>", "Größe", "\\U01F600", "A", "a", "%% ]", "x" * 60]
COLOURS = ['"red"', '"#12345678"', "[0.2, 0.4, 0.6, 0.5]", '"white"', '"goldenrod"']
DONE, AT_FAULT = 0, 1
VOLUME = 2e-3  # of the mesh's own; Draco's 14 bits and STL's floats round


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
    joins = [f"union(blend = {blend(rng)})", f"difference(blend = {blend(rng)})", f"intersection(blend = {blend(rng)})",
             "union()", "difference()", "hull()"]
    around = [f"translate({vector(rng, -6, 6)})", f"rotate({vector(rng, -180, 180)})", f"mirror([1, {number(rng, -2, 2)}, 1])",
              f"scale([{number(rng, 0.6, 2)}, 1, {number(rng, 0.6, 2)}])", f"color({rng.choice(COLOURS)})",
              f"material({number(rng, 0.01, 0.9)}, {number(rng, 0.1, 0.9)})", f"offset3d({number(rng, -0.2, 0.6)})",
              f"shell({number(rng, 0.8, 2)})", f"twist({number(rng, -5, 5)})", f"repeat([20, 0, 0], [{rng.randint(1, 3)}, 1, 1])",
              f"resize([{number(rng, 5, 12)}, 0, 0], auto = true)"]
    words, most = (rng.choice(joins), 3) if rng.random() < 0.6 else (rng.choice(around), 1)
    return words + " { " + " ".join(solid(rng, depth - 1) for _ in range(rng.randint(min(2, most), most))) + " }"


def scene(rng):
    """One to three solids, in parts or not; the whole somewhere, large or small."""
    around = rng.choice(["", "", "", "scale(1e-3) ", "scale(300) ", "translate([1000, -500, 20]) "])
    return "".join(around + (f'part("{rng.choice(NAMES)}") ' if rng.random() < 0.4 else "") + solid(rng, rng.randint(1, 3)) +
                   "\n" for _ in range(rng.randint(1, 3)))


def differences(stats):
    """What the files have that the mesh has not."""
    mesh = stats["mesh"]
    faults = [] if mesh["manifold"] and mesh["triangles"] else ["the mesh is no closed manifold"]
    if len(stats["files"]) != len(KINDS):
        faults.append(f"{len(stats['files'])} files were looked at")
    for file in stats["files"]:
        for key in ("triangles", "components", "genus"):
            if file.get(key) != mesh.get(key):
                faults.append(f"{file['name']}: {key} {file.get(key)}, not {mesh.get(key)}")
        if not file["manifold"]:
            faults.append(f"{file['name']}: no closed manifold")
        if abs(file["volume"] - mesh["volume"]) > VOLUME * abs(mesh["volume"]):
            faults.append(f"{file['name']}: volume {file['volume']}, not {mesh['volume']}")
    return faults


def tried(text, settings, folder):
    """(status, what is wrong)."""
    with open(os.path.join(folder, "scene.txt"), "w", encoding="utf-8") as file:
        file.write(text)
    outputs = [word for kind in KINDS for word in ("-o", "out." + kind)]
    command = [cli.PROGRAM, "scene.txt", *settings, *outputs, "--stats=stats.json", "--timeout", "60", "-q"]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600, check=False)
    if result.returncode != DONE:
        # E0505: too fine for a format's steps, as a solid of a thousand units off is for Draco's
        told = "error" in result.stderr and result.returncode == AT_FAULT or "E0902" in result.stderr or "E0505" in result.stderr
        return result.returncode, [] if told else [f"exit status {result.returncode}", result.stderr]
    with open(os.path.join(folder, "stats.json"), encoding="utf-8") as file:
        return DONE, differences(json.load(file))


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    refused, bad = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for i in range(count):
            rng = random.Random(f"{seed} {i}")
            text, settings = scene(rng), ["-r", str(rng.randint(12, 40))] if i % 2 else ["--quality", "draft"]
            status, faults = tried(text, settings, folder)
            refused += status != DONE
            bad += bool(faults)
            if faults:
                print(f"scene {i} of seed {seed}, {' '.join(settings)}:\n{text}  " + "\n  ".join(faults))
    print(f"{count} scenes, {count - refused} written in {len(KINDS)} formats and read back, {refused} refused, {bad} at fault")
    return 1 if bad or refused * 2 > count else 0


if __name__ == "__main__":
    sys.exit(main())
