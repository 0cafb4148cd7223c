# SPDX-License-Identifier: MIT
"""A build by the other compiler writes the same files for every scene of the repository.

Usage: test_compilers.py CELLS [--build FOLDER] [STEP | --of N]: scenes as for test_machines.py, in equal cells and, every
third of them, in cells that follow the shape; and random joins of polyhedra, triangle by triangle. Keeps the other
compiler's build in FOLDER. Exit status 77 (a skip) where clang is not installed.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

import cli
from random_joins import write_scene
from same_bytes import chosen_scenes, differences, mesh

PROGRAM = os.environ["CSGMESH"]
SOURCE = os.environ["CSGMESH_SOURCE"]
JOINS = 32


def build_with(cc, cxx, folder):
    """The program, without the libraries that take long to compile."""
    setup = ["meson", "setup", folder, SOURCE, "-Dbuildtype=release", "-Dtests=disabled", "-Dwerror=false",
             "-Ddraco=disabled", "-Dopenmesh=disabled", "-Dtinygltf=disabled"]
    program = os.path.join("tools", "csgmesh", "csgmesh")
    if os.path.exists(os.path.join(folder, "build.ninja")):
        setup.insert(2, "--reconfigure")
    cached = "ccache " if shutil.which("ccache") else ""
    for command in (setup, ["ninja", "-C", folder, program]):
        result = subprocess.run(command, env={**os.environ, "CC": cached + cc, "CXX": cached + cxx}, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if result.returncode != 0:
            raise AssertionError(f"{' '.join(command)}\n{result.stdout[-4000:]}")
    return os.path.join(folder, program)


def other_compiler():
    is_clang = "clang" in os.environ["CSGMESH_COMPILER"]
    cc, cxx = ("gcc", "g++") if is_clang else ("clang", "clang++")
    return (cc, cxx) if shutil.which(cc) and shutil.which(cxx) else None


def is_joined(scene):
    """Whether triangles of polyhedra went out by themselves."""
    result = subprocess.run([PROGRAM, scene, "--facets=exact", "--stats", "-q", "-o", os.devnull, "-f", "ply"],
                            capture_output=True, text=True, check=True)
    return json.loads(result.stdout)["lattice"].get("own_triangles", 0) > 0


def differences_of_joins(theirs, name, folder):
    """Between the two programs; nothing to compare where they are built without the library that joins."""
    if not cli.has_library("Manifold"):
        return []
    faults, out = [], os.path.join(folder, "join.glb")
    every = [write_scene(folder, seed) for seed in range(JOINS)]
    for scene in every:
        faults += differences(scene, mesh(PROGRAM, scene, out, "--facets=exact"), [
            (f"by {name}", lambda: mesh(theirs, scene, out, "--facets=exact"))])
    joined = sum(map(is_joined, every))
    assert 4 * joined > 3 * JOINS, f"only {joined} of {JOINS} scenes are joined triangle by triangle"
    return faults


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build")
    parser.add_argument("cells")
    options, words = parser.parse_known_args()
    cells, other = options.cells, other_compiler()
    if not other:
        print("there is no other compiler here (clang beside gcc): skipped")
        return 77
    faults, every = [], chosen_scenes(words)
    with tempfile.TemporaryDirectory() as folder:
        theirs = build_with(*other, options.build or os.path.join(folder, "build"))
        for i, scene in enumerate(every):
            runs = [("ply", ("-r", cells)), ("glb", ("-r", cells))] + [("glb", ("--quality", "normal"))] * (i % 3 == 0)
            for kind, settings in runs:
                out = os.path.join(folder, "out." + kind)
                faults += differences(scene, mesh(PROGRAM, scene, out, *settings), [
                    (f"{' '.join(settings)} {kind} by {other[0]}", lambda: mesh(theirs, scene, out, *settings))])
        faults += differences_of_joins(theirs, other[0], folder)
    for fault in faults:
        print("differs:", fault)
    print(f"{len(every)} scenes, {len(faults)} differences")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
