# SPDX-License-Identifier: MIT
"""Random scenes of polyhedra that sharp operators join, here and there with a ball among them."""
import os
import random


def _length(chance, least, most):
    return f"{chance.uniform(least, most):.4f}"


def _place(chance, solid):
    angles = [chance.randrange(0, 360, chance.choice([1, 90])) for _ in range(3)]
    at = ", ".join(_length(chance, -9, 9) for _ in range(3))
    return f"translate([{at}]) rotate({angles}) {solid}"


def _polyhedron(chance):
    def some(least, most):
        return _length(chance, least, most)
    def box(of):
        return f"cube([{', '.join(of() for _ in range(3))}], center = true);"
    sides = chance.choice([3, 5, 16, 24])
    return chance.choice([
        lambda: box(lambda: some(2, 20)),
        lambda: f"linear_extrude({some(2, 9)}) polygon([[0, 0], [{some(5, 9)}, 1], [{some(5, 9)}, {some(6, 9)}], [3, 4], [-2, 6]]);",
        lambda: f"hull() {{ {' '.join(_place(chance, box(lambda: some(0.5, 3))) for _ in range(3))} }}",
        lambda: f"sphere({some(2, 9)}, $fn = {sides});",
        lambda: f"cylinder(h = {some(4, 24)}, r1 = {some(1, 6)}, r2 = {some(1, 6)}, $fn = {sides}, center = true);"])()


def _tree(chance, depth):
    if depth == 0:
        return _place(chance, _polyhedron(chance))
    operator = chance.choice(["union", "union", "difference", "intersection"])
    operands = " ".join(_tree(chance, chance.randrange(depth)) for _ in range(chance.randrange(2, 5)))
    return f"{operator}() {{ {operands} }}"


def write_scene(folder, seed):
    """The scene of a seed: never empty, as a bar stands beside the rest. Its path."""
    chance = random.Random(seed)
    ball = f"translate([{_length(chance, 12, 18)}, 0, 0]) sphere(3);" if chance.random() < 0.3 else ""
    path = os.path.join(folder, f"join-{seed}.txt")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"union() {{ {_tree(chance, 3)} difference() {{ cube([40, 5, 5], center = true); {ball} "
                   f"{_place(chance, _polyhedron(chance))} }} }}\n")
    return path
