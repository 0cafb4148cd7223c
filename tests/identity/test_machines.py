# SPDX-License-Identifier: MIT
"""Every scene of the repository gives the same file, byte for byte, for every instruction set, number of
threads, with pruning and without, streamed to its file or by way of a mesh in memory.

Usage: test_machines.py CELLS CELLS_WITHOUT_PRUNING [STEP]: of every STEP-th scene; with --of N of the N-th, counted
round and round
"""
import functools
import os
import subprocess
import sys
import tempfile

from same_bytes import chosen_scenes, differences, mesh, scenes

PROGRAM = os.environ["CSGMESH"]
INSTRUCTION_SETS = ["scalar", "sse2", "avx2", "avx512", "neon"]


def can_run(isa):
    """Whether this build and this processor have it; all have the first."""
    return subprocess.run([PROGRAM, "check", scenes()[0]], env={**os.environ, "CSGMESH_ISA": isa},
                          capture_output=True, check=False).returncode == 0


def faults_of(scene, cells, unpruned_cells, folder, instruction_sets):
    ply, glb = os.path.join(folder, "a.ply"), os.path.join(folder, "a.glb")
    make = functools.partial(mesh, PROGRAM, scene)
    variants = [(f"-j {n}", functools.partial(make, ply, "-r", cells, "-j", n)) for n in (2, 5)]
    # not the last one: the program takes it by itself, for the first file
    variants += [(isa, functools.partial(make, ply, "-r", cells, "-j", 1, env={"CSGMESH_ISA": isa}))
                 for isa in instruction_sets[:-1]]
    variants += [("in memory", functools.partial(make, "-", "-f", "ply", "-r", cells))]
    faults = differences(scene, make(ply, "-r", cells, "-j", 1), variants)
    faults += differences(scene, make(glb, "-r", cells, "-j", 1), [
        ("GLB, -j 2", functools.partial(make, glb, "-r", cells, "-j", 2)),
        ("GLB, in memory", functools.partial(make, "-", "-f", "glb", "-r", cells))])
    return faults + differences(scene, make(ply, "-r", unpruned_cells), [
        ("--no-prune", functools.partial(make, ply, "-r", unpruned_cells, "--no-prune"))])


def main():
    cells, unpruned_cells = int(sys.argv[1]), int(sys.argv[2])
    every, instruction_sets = chosen_scenes(sys.argv[3:]), [isa for isa in INSTRUCTION_SETS if can_run(isa)]
    with tempfile.TemporaryDirectory() as folder:
        faults = [fault for scene in every
                  for fault in faults_of(scene, cells, unpruned_cells, folder, instruction_sets)]
    for fault in faults:
        print("differs:", fault)
    print(f"{len(every)} scenes, {' '.join(instruction_sets)}: {len(faults)} differences")
    return 1 if faults or "scalar" not in instruction_sets else 0


if __name__ == "__main__":
    sys.exit(main())
