#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How time and memory grow with the number of primitives, from text to a finished PLY file.

    tests/bench/million.py build/tools/csgmesh/csgmesh
    tests/bench/million.py OLD NEW --most 100000 --rounds 1

Three scenes of up to a million balls at 512 cells: at random places, the radius such that they fill as
much (spheres.txt); hidden in a large one, so that what is seen stays the same (hidden.txt); from nested
loops (loops.txt). `check` is the language alone. Of the rounds the fastest counts. A table in Markdown.
"""
import argparse
import os
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))


def run(command):
    """(wall seconds, processor seconds, peak MB) of a command that must succeed."""
    begin = time.monotonic()
    process = os.posix_spawn(command[0], command, os.environ)
    _, status, usage = os.wait4(process, 0)
    if status:
        raise SystemExit(f"failed: {' '.join(command)}")
    return time.monotonic() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def defines(scene, count):
    if scene == "loops":
        return ["-D", f"side={round(count ** 0.5)}"]
    radius = ["-D", f"radius={0.06 * (1000 / count) ** (1 / 3):.6g}"] if scene == "spheres" else []
    return ["-D", f"count={count}"] + radius


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", type=os.path.abspath)
    parser.add_argument("--scenes", default="spheres,hidden,loops")
    parser.add_argument("--most", type=int, default=1000000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--cells", default="512")
    args = parser.parse_args()
    print("| scene | primitives | program | check s | check MB | mesh s | mesh cpu s | mesh MB |")
    print("|---|---:|---|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in args.scenes.split(","):
            count = 100
            while count <= args.most:
                for number, program in enumerate(args.programs):
                    text = [os.path.join(HERE, scene + ".txt"), *defines(scene, count), "-q"]
                    mesh = [program, "mesh", *text, "-r", args.cells, "-o", os.path.join(folder, "o.ply")]
                    check = min(run([program, "check", *text]) for _ in range(args.rounds))
                    whole = min(run(mesh) for _ in range(args.rounds))
                    print(f"| {scene} | {count} | {number + 1} | {check[0]:.3f} | {check[2]:.0f} "
                          f"| {whole[0]:.3f} | {whole[1]:.3f} | {whole[2]:.0f} |", flush=True)
                count *= 10


if __name__ == "__main__":
    main()
