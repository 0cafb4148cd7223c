#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fuzzes with libFuzzer (the parser, the evaluator, the readers of drawings...), from the committed inputs on.

Usage: run.py [--seconds N] [--seed N] [--build FOLDER] [--work FOLDER] [--minimise] [TARGET ...]

Builds a clang build of its own in FOLDER. --work keeps what the runs find between calls; findings stay
there as crash-*, timeout-*, leak-*: mend them and put them in findings/TARGET. --minimise makes
corpus/TARGET anew from the work folder. Exit status 77, a skip, where there is no clang with libFuzzer.
"""
import argparse
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
INPUTS = os.path.join(HERE, "..", "data", "fuzz")
ROOT = os.path.join(HERE, "..", "..")
ENVIRONMENT = {**os.environ, "ASAN_OPTIONS": "detect_leaks=1:allocator_may_return_null=1",
               "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1"}
LONGEST, LARGEST = 1200, 200 << 10  # bytes: of a committed input, of a committed corpus


def can_fuzz():
    """Does this machine's clang link libFuzzer?"""
    if not shutil.which("clang") or not shutil.which("clang++"):
        return False
    with tempfile.TemporaryDirectory() as folder:
        source = os.path.join(folder, "a.c")
        with open(source, "w", encoding="utf-8") as file:
            file.write("int LLVMFuzzerTestOneInput(const char *d, long n) { return d && n < 0; }\n")
        return subprocess.run(["clang", "-fsanitize=fuzzer,address", source, "-o", source + ".out"],
                              capture_output=True, check=False).returncode == 0


def known_targets(folder):
    """Paths of the fuzz_* that the build makes, by their names."""
    rules = subprocess.run(["ninja", "-C", folder, "-t", "targets", "all"], check=True,
                           capture_output=True, text=True).stdout
    return {name: path for path, name in re.findall(r"^(tests/\w+/fuzz_(\w+)):", rules, flags=re.M)}


def build(folder, targets):
    # b_lundef: clang's sanitizers are not in shared libraries. Not werror: the house compiles with gcc.
    if not os.path.exists(os.path.join(folder, "build.ninja")):
        subprocess.run(["meson", "setup", folder, ROOT, "-Dfuzz=true", "-Dwerror=false", "-Db_lundef=false",
                        "-Db_sanitize=address,undefined", "-Doptimization=2", "-Ddebug=true",
                        "-Db_ndebug=false"], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "CC": "clang", "CXX": "clang++"})
    paths = known_targets(folder)
    chosen = {name: paths[name] for name in sorted(targets or paths)}
    subprocess.run(["ninja", "-C", folder, *chosen.values()], check=True, stdout=subprocess.DEVNULL)
    return {name: os.path.abspath(os.path.join(folder, path)) for name, path in chosen.items()}


def inputs(target):
    folders = [os.path.join(INPUTS, kind, target) for kind in ("corpus", "findings")]
    return [folder for folder in folders if os.path.isdir(folder)]


def words_of(target):
    """The target's own dictionary, else that of scenes."""
    own = os.path.join(HERE, "dictionaries", target + ".dict")
    return own if os.path.exists(own) else os.path.join(HERE, "scene.dict")


def fuzz(program, target, work, options):
    corpus = os.path.join(work, target)
    os.makedirs(corpus, exist_ok=True)
    log = os.path.join(work, target + ".log")
    with open(log, "wb") as file:
        result = subprocess.run(
            [program, f"-max_total_time={options.seconds}", f"-seed={options.seed}", "-timeout=10", "-rss_limit_mb=2000",
             "-print_final_stats=1", "-dict=" + words_of(target),
             "-artifact_prefix=" + work + os.sep, corpus, *inputs(target)],
            stdout=file, stderr=subprocess.STDOUT, env=ENVIRONMENT, check=False)
    with open(log, encoding="utf-8", errors="replace") as file:
        text = file.read()
    runs = [line.split()[-1] for line in text.split("\n") if "number_of_executed_units" in line]
    print(f"{target}: {runs[0] if runs else '?'} inputs, exit status {result.returncode}")
    if result.returncode != 0:
        print(text[-6000:])
    return result.returncode == 0


def minimise(program, target, work):
    """The committed corpus anew: what adds an edge, the shortest first, up to LARGEST."""
    chosen = os.path.join(work, target + ".min")
    shutil.rmtree(chosen, ignore_errors=True)
    os.makedirs(chosen)
    subprocess.run([program, "-merge=1", "-use_counters=0", f"-max_len={LONGEST}", chosen,
                    os.path.join(work, target), *inputs(target)],
                   stderr=subprocess.DEVNULL, env=ENVIRONMENT, check=True)
    corpus = os.path.join(INPUTS, "corpus", target)
    shutil.rmtree(corpus, ignore_errors=True)
    os.makedirs(corpus)
    total = 0
    for path in sorted(glob.glob(os.path.join(chosen, "*")), key=os.path.getsize):
        total += os.path.getsize(path)
        if total <= LARGEST:
            shutil.copy(path, os.path.join(corpus, os.path.basename(path)[:12]))
    print(f"{target}: {len(os.listdir(corpus))} inputs kept")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0, help="of libFuzzer; 0 is another one each time")
    parser.add_argument("--build", default=os.path.join(ROOT, "build-fuzz"))
    parser.add_argument("--work")
    parser.add_argument("--minimise", action="store_true")
    parser.add_argument("targets", nargs="*")
    options = parser.parse_args()
    if not can_fuzz():
        print("no clang with libFuzzer here: nothing is fuzzed")
        sys.exit(77)
    targets = build(options.build, options.targets)
    good = True
    with tempfile.TemporaryDirectory() as temporary:
        work = os.path.abspath(options.work or temporary)
        os.makedirs(work, exist_ok=True)
        for target, program in targets.items():
            if options.minimise:
                minimise(program, target, work)
            else:
                good = fuzz(program, target, work, options) and good
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
