#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Has a run become slower? Counted in instructions, which are the same on a busy machine: tools/bench --instructions.

    instructions.py [--build FOLDER] [--write] [SCENE ...]

Runs the program for nothing, S1 to S5, a few models and parts, and `check` of three scenes that keep the evaluator busy, under valgrind, one
thread, with AVX2 kernels, and compares the instructions of each, without those of the start, with instructions.csv beside this file. What needs 10 % more is named, and the exit status is 1; what needs 10 %
less is named too, so that the file can be renewed (--write). Counts depend on the compiler and the C library: where they
are others than those that the file names, nothing can be compared, and the exit status is 77, a skip.
"""
import argparse
import concurrent.futures
import csv
import glob
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.abspath(os.path.join(HERE, "..", ".."))
BASELINE = os.path.join(HERE, "instructions.csv")
ALLOWED = 0.10
CELLS = {"stress": 64, "models": 32, "parts": 32}
MODELS = ["models/bracket", "models/knob", "models/vase", "parts/bottle", "parts/chess_pawn", "parts/hook", "parts/mug",
          "parts/spool"]
START = "start"  # of the program alone, --version: mostly the dynamic linker, which every library makes dearer
CHECKED = ["bench/library.scad", "bench/lists.scad", "bench/tree.scad"]  # below tests


def scenes():
    found = sorted(glob.glob(os.path.join(ROOT, "scenes", "stress", "s[1-5]*.txt")))
    return [START] + [os.path.relpath(path, os.path.join(ROOT, "scenes")) for path in found] + [name + ".txt" for name in MODELS] + CHECKED


def environment(build):
    """What counts depend on besides the program."""
    compiler = subprocess.run([os.path.join(build, "tests", "bench", "stages"), "--compiler"], capture_output=True,
                              text=True, check=True).stdout.strip()
    with open(os.path.join(build, "meson-info", "intro-buildoptions.json"), encoding="utf-8") as file:
        kind = re.search(r'"name": "buildtype", "value": "(\w+)"', file.read())
    return f"{compiler}, {kind.group(1) if kind else '?'}, {' '.join(platform.libc_ver())}, {platform.machine()}"


def count(program, scene, folder):
    """Instructions of one run, or None where it fails."""
    name = scene.replace(os.sep, "-")
    if scene == START:
        words = ["--version"]
    elif scene in CHECKED:
        words = ["check", os.path.join(ROOT, "tests", scene), "-q"]
    else:
        words = [os.path.join(ROOT, "scenes", scene), "-q", "-j", "1", "-r", str(CELLS[scene.split(os.sep)[0]]), "-o",
                 os.path.join(folder, name + ".ply")]
    result = subprocess.run(
        ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null", program, *words],
        env={**os.environ, "CSGMESH_ISA": "avx2"}, capture_output=True, text=True, check=False)
    found = re.search(r"I\s+refs:\s+([\d,]+)", result.stderr)
    if result.returncode != 0 or not found:
        print(f"{scene}: exit status {result.returncode}\n{result.stderr[-1000:]}")
        return None
    return int(found.group(1).replace(",", ""))


def count_all(program, chosen):
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(chosen, pool.map(lambda scene: count(program, scene, folder), chosen)))


def read_baseline():
    """(environment, instructions by scene)"""
    with open(BASELINE, encoding="utf-8", newline="") as file:
        where = file.readline().removeprefix("#").strip()
        return where, {row["scene"]: int(row["instructions"]) for row in csv.DictReader(file)}


def write_baseline(where, counts):
    with open(BASELINE, "w", encoding="utf-8", newline="") as file:
        file.write(f"# {where}\n")
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["scene", "instructions"])
        rows.writerows(counts.items())


def compare(counts, kept):
    """Prints a table; the scenes that have become slower, and those that were not counted."""
    slower, start, kept_start = [], counts.get(START) or 0, kept.get(START, 0)
    for scene, now in counts.items():
        if now is None:
            slower.append(scene)
            continue
        if scene not in kept:
            print(f"{scene}: {now / 1e6:.1f} million; not in {os.path.basename(BASELINE)}: --write")
            continue
        own = scene != START  # what the scene takes beside the start
        ratio = (now - own * start) / (kept[scene] - own * kept_start) - 1
        word = "SLOWER" if ratio > ALLOWED else "faster: renew the file with --write" if ratio < -ALLOWED else ""
        print(f"{scene:32} {now / 1e6:10.1f} million {100 * ratio:+7.2f} % {word}")
        slower += [scene] * (ratio > ALLOWED)
    return slower


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build"))
    parser.add_argument("--program", help="the csgmesh to count (default: the build folder's)")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("scenes", nargs="*", help="parts of their paths")
    options = parser.parse_args(words)
    if not shutil.which("valgrind"):
        print("valgrind is not installed: nothing is counted")
        return 77
    chosen = [scene for scene in scenes() if scene == START or not options.scenes or any(word in scene for word in options.scenes)]
    if chosen == [START]:
        parser.error("no such scenes")
    program = options.program or os.path.join(options.build, "tools", "csgmesh", "csgmesh")
    where = environment(options.build)
    if options.write:
        counts = count_all(program, chosen)
        if None in counts.values():
            return 1
        write_baseline(where, {**(read_baseline()[1] if options.scenes else {}), **counts})
        return 0
    kept_where, kept = read_baseline()
    if where != kept_where:
        print(f"cannot compare: this is {where}, the counts kept are of {kept_where}")
        return 77
    slower = compare(count_all(program, chosen), kept)
    if slower:
        print(f"more than {ALLOWED:.0%} slower, or failed: {', '.join(slower)}")
    return 1 if slower else 0


if __name__ == "__main__":
    sys.exit(main())
