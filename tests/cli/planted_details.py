# SPDX-License-Identifier: MIT
"""Small details planted on a block at random: the default mesh has each of them, or a warning says that something is missing.

Usage: planted_details.py COUNT SEED

Each of COUNT blocks, every other one turned, gets ten details of 1 to 8 T (docs/tolerance.md), T being the tolerance of its
mesh: bumps, dents, needles, plates, slots, balls, cavities, and cubes above a gap. A detail is there when a vertex lies
where its far end is. One that is lost in silence is a fault.
"""
import collections
import math
import os
import random
import subprocess
import sys
import tempfile

import cli

SIDES = (8, 6, 2)
DETAILS = 10


def rotation(angles):
    """The matrix of rotate(angles), by rows."""
    (a, b, c), (s, t, u) = ([f(math.radians(x)) for x in angles] for f in (math.cos, math.sin))
    return [[c * b, c * t * s - u * a, c * t * a + u * s], [u * b, u * t * s + c * a, u * t * a - c * s], [-t, b * s, b * a]]


def bump(p):
    return "add", f"{p.on_top}translate([0,0,{p.a / 2 - 1e-3 * p.a:.7f}])cube([{p.a:.7f},{p.a:.7f},{p.a * 1.002:.7f}],center=true);", p.a, (0.4, 1.6)


def dent(p):
    return "cut", f"{p.on_top}cube([{p.a:.7f},{p.a:.7f},{2 * p.a:.7f}],center=true);", p.a, (-1.6, -0.4)


def needle(p):
    return ("add", f"{p.on_top}translate([0,0,{4 * p.a - 1e-3 * p.a:.7f}])cube([{p.a:.7f},{p.a:.7f},{8 * p.a:.7f}],center=true);", p.a,
            (6, 9))


def plate(p):
    return ("add", f"{p.on_top}translate([0,0,{4 * p.a - 1e-3 * p.a:.7f}])cube([{p.a:.7f},{p.length:.7f},{8 * p.a:.7f}],center=true);",
            max(p.length, 8 * p.a), (6, 9))


def slot(p):
    return "cut", f"{p.on_top}cube([{p.a:.7f},{p.length:.7f},{16 * p.a:.7f}],center=true);", max(p.length, 8 * p.a), (-9, -6)


def ball(p):
    return "add", f"translate([{p.x:.6f},{p.y:.6f},{1 + 3 * p.a:.6f}])sphere({p.a / 2:.7f});", p.a, (2.3, 3.7)


def cavity(p):
    return "cut", f"translate([{p.x:.6f},{p.y:.6f},{1 - 10 * p.a:.6f}])sphere({p.a / 2:.7f});", p.a, (-10.7, -9.3)


def gap(p):
    return ("add", f"{p.on_top}translate([0,0,{p.a + p.length / 2:.7f}])cube([{p.length:.7f},{p.length:.7f},{p.length:.7f}],center=true);",
            max(p.length, 8 * p.a), (0.5, 1.5))


KINDS = [bump, dent, needle, plate, slot, ball, cavity, gap]
# x and y on the upper side, z = 1; a: the size; length: of what is longer
Place = collections.namedtuple("Place", "x y a length on_top")


def planted(rng, tolerance):
    """(name, size in T, what, scene text, (x, y, reach), lowest and highest z of the far end) of each detail."""
    spots = [(i, j) for i in range(5) for j in range(4)]
    rng.shuffle(spots)
    for i, j in spots[:DETAILS]:
        a = tolerance * 2 ** rng.uniform(0.02, 3)
        x, y = -3.2 + 1.6 * i + rng.uniform(-0.3, 0.3), -2.2 + 1.45 * j + rng.uniform(-0.3, 0.3)
        place = Place(x, y, a, min(20 * a, 0.5), f"translate([{x:.6f},{y:.6f},1])rotate([0,0,{rng.uniform(0, 90):.3f}])")
        kind = rng.choice(KINDS)
        what, text, reach, (low, high) = kind(place)
        yield kind.__name__, a / tolerance, what, text, (x, y, 0.75 * reach + 1e-9), (1 + low * a, 1 + high * a)


def block(rng):
    """The scene's text, its turn, and its details."""
    angles = [round(rng.uniform(-180, 180), 3) for _ in range(3)] if rng.random() < 0.5 else [0, 0, 0]
    turn = rotation(angles)
    longest = max(sum(abs(turn[i][j]) * side for j, side in enumerate(SIDES)) for i in range(3))
    details = list(planted(rng, 2.0 ** math.floor(math.log2(longest / 1000))))
    text = {what: " ".join(d[3] for d in details if d[2] == what) for what in ("add", "cut")}
    return f"rotate({angles}) difference() {{ union() {{ cube({list(SIDES)}, center = true); {text['add']} }} {text['cut']} }}\n", turn, details


def vertices(path, turn):
    """Turned back."""
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("v "):
                at = [float(word) for word in line.split()[1:4]]
                yield [sum(turn[i][axis] * at[i] for i in range(3)) for axis in range(3)]


def lost_of(folder, rng):
    """The details that are lost in silence, and how many there were and were named."""
    text, turn, details = block(rng)
    with open(os.path.join(folder, "a.scad"), "w", encoding="utf-8") as file:
        file.write(text)
    done = subprocess.run([cli.PROGRAM, "a.scad", "-o", "a.obj"], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        return [f"status {done.returncode}: {done.stderr[-500:]}"], 0, 0
    points = list(vertices(os.path.join(folder, "a.obj"), turn))
    lost = [f"a {name} of {size:.2f} T at {x:.3f}, {y:.3f}" for name, size, _, _, (x, y, reach), (low, high) in details
            if not any(abs(p[0] - x) <= reach and abs(p[1] - y) <= reach and low <= p[2] <= high for p in points)]
    named = len(lost) if "W0406" in done.stderr else 0
    return [] if named else [f"{what}:\n{text}" for what in lost], len(details), named


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    total, warned, bad = 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for i in range(count):
            lost, planted_here, named = lost_of(folder, random.Random(f"{seed} {i}"))
            total, warned, bad = total + planted_here, warned + named, bad + len(lost)
            for what in lost:
                print(f"block {i} of seed {seed}: lost, {what}")
    print(f"{count} blocks, {total} details, {warned} lost with a warning, {bad} at fault")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
