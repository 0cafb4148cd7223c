# SPDX-License-Identifier: MIT
"""Memory that runs out within libraries: there is less of it than the run needs, or one allocation of the whole program fails.

Usage: failing_allocations.py COUNT SEED

For each library a command that uses it, COUNT times, with an amount or an allocation at random. The program ends by itself with
status 0, 1 or 2, says why, and leaves no file that it has not finished. Needs a C compiler and a loader that heeds LD_PRELOAD (status
77 without).
"""
import os
import random
import shlex
import subprocess
import sys
import tempfile

import cli

SKIPPED = 77
# Counts what malloc and its like are asked for; operator new of C++ asks malloc. The count goes to a file at the end.
SHIM = r"""
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
void __libc_free(void *), *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
static atomic_long count, used, peak, at, most;
__attribute__((constructor)) static void begin(void)
{
    at = getenv("FAIL_AT") ? atol(getenv("FAIL_AT")) : 0;
    most = getenv("FAIL_BYTES") ? atol(getenv("FAIL_BYTES")) : 0;
}
__attribute__((destructor)) static void end(void)
{
    char text[64];
    const char *path = getenv("FAIL_COUNT");
    int file = path ? open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    if (file >= 0 && write(file, text, (size_t)snprintf(text, sizeof text, "%ld %ld", (long)count, (long)peak)))
        close(file);
}
static int fails(size_t size)
{
    int is_now = at > 0 && atomic_fetch_add(&count, 1) + 1 == at;
    if (at <= 0)
        atomic_fetch_add(&count, 1);
    is_now |= most > 0 && used + (long)size > most;
    if (is_now)
        errno = ENOMEM;
    return is_now;
}
static void *keep(void *p)
{
    long now = p ? atomic_fetch_add(&used, (long)malloc_usable_size(p)) + (long)malloc_usable_size(p) : 0, before = peak;
    while (now > before && !atomic_compare_exchange_weak(&peak, &before, now))
        ;
    return p;
}
static void drop(void *p) { used -= p ? (long)malloc_usable_size(p) : 0; }
void *malloc(size_t size) { return fails(size) ? 0 : keep(__libc_malloc(size)); }
void *calloc(size_t n, size_t size) { return fails(n * size) ? 0 : keep(__libc_calloc(n, size)); }
void *realloc(void *p, size_t size)
{
    if (fails(size))
        return 0;
    drop(p);
    return keep(__libc_realloc(p, size));
}
void free(void *p)
{
    drop(p);
    __libc_free(p);
}
"""
BALLS = "union(blend = 1) { sphere(4); translate([3, 2, 1]) sphere(3); }\n"
# what it is about: the arguments; the first word ending in .txt is a scene of SCENES
JOBS = {
    "Draco writes": ["balls.txt", "-r", "12", "-o", "out.drc"], "Draco reads": ["info", "in.drc"],
    "Draco in glTF": ["balls.txt", "-r", "12", "-o", "out.glb", "--compress=draco"], "tinygltf": ["info", "in.glb"],
    "tinygltf and Draco": ["info", "draco.glb"], "meshoptimizer": ["balls.txt", "-r", "12", "-o", "out.glb", "--compress=meshopt"],
    "libzip writes": ["balls.txt", "-r", "12", "-o", "out.3mf"], "libzip and expat read": ["info", "in.3mf"],
    "FreeType, HarfBuzz, fontconfig": ["text.txt", "-r", "12", "-o", "out.stl"], "Qhull": ["hull.txt", "-r", "12", "-o", "out.stl"],
    "Clipper": ["flat.txt", "-o", "out.svg"], "OpenMesh": ["convert", "in.stl", "--simplify", "0.1", "-o", "out.stl"],
    "libpng": ["render", "balls.txt", "--size", "24x24", "-o", "out.png"], "JSON": ["params", "balls.txt", "-p", "sets.json", "-P", "one"],
    "Manifold": ["joined.txt", "--quality", "draft", "-o", "out.ply"],
    "cells that follow the shape": ["balls.txt", "--quality", "draft", "-o", "out.obj"],
}
# A single allocation that fails among others that do not ends these libraries: nlohmann's values allocate in destructors,
# fontconfig looks at no result. Memory that has ended is found out before they begin.
ABORTS = ("tinygltf", "tinygltf and Draco", "FreeType, HarfBuzz, fontconfig")
SCENES = {"balls.txt": BALLS, "joined.txt": 'difference() { import("in.stl"); rotate(40) cube([3, 4, 50], center = true); sphere(3); }\n',
          "text.txt": 'linear_extrude(2) text("Ag&");\n', "flat.txt": "offset(1) difference() { square(9); circle(3); }\n",
          "hull.txt": "hull() { cube(2); translate([4, 1, 3]) cube(1); }\n", "sets.json": '{"parameterSets": {"one": {"x": "1"}}, "fileFormatVersion": "1"}\n'}


def run(words, folder, shim, how):
    environment = {**os.environ, "LD_PRELOAD": shim, "FAIL_COUNT": os.path.join(folder, "count"), **how}
    return subprocess.run([cli.PROGRAM, *words, "-j", "2"] if words[0] not in ("info", "params") else [cli.PROGRAM, *words], cwd=folder,
                          env=environment, capture_output=True, check=False, timeout=120)


def faults_of(words, folder, shim, how, before):
    try:
        done = run(words, folder, shim, how)
    except subprocess.TimeoutExpired:
        return ["it does not end"]
    said, faults = done.stderr.decode(errors="replace"), []
    left = [name for name in os.listdir(folder) if name not in before]
    if done.returncode not in (0, 1, 2):
        faults.append(f"status {done.returncode}: {said[-500:]}")
    if done.returncode == 2 and not said:
        faults.append("trouble without a word")
    if done.returncode and left:
        faults.append(f"left behind: {left}")
    for name in left:
        os.unlink(os.path.join(folder, name))
    return faults


def prepare(folder):
    """The files that are read, and the shim; None where it does not work."""
    for name, text in SCENES.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    for name, more in (("in.drc", []), ("in.glb", []), ("draco.glb", ["--compress=draco"]), ("in.3mf", []), ("in.stl", [])):
        subprocess.run([cli.PROGRAM, "balls.txt", "-r", "12", "-q", "-o", name, *more], cwd=folder, check=False, stderr=subprocess.DEVNULL)
    source, shim = os.path.join(folder, "shim.c"), os.path.join(folder, "shim.so")
    with open(source, "w", encoding="utf-8") as file:
        file.write(SHIM)
    try:
        subprocess.run([*shlex.split(os.environ.get("CSGMESH_CC", "cc")), "-shared", "-fPIC", "-O1", "-o", shim, source], check=True,
                       capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    run(["info", "in.stl"], folder, shim, {})
    return shim if os.path.exists(os.path.join(folder, "count")) else None


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    bad = tried = 0
    with tempfile.TemporaryDirectory() as folder:
        shim = prepare(folder)
        if not shim:
            print("no compiler, or a loader that does not heed LD_PRELOAD: nothing was tried")
            return SKIPPED
        before = set(os.listdir(folder))
        for what, words in JOBS.items():
            whole = run(words, folder, shim, {})
            with open(os.path.join(folder, "count"), encoding="utf-8") as file:
                allocations, peak = map(int, file.read().split())
            for name in set(os.listdir(folder)) - before:
                os.unlink(os.path.join(folder, name))
            if whole.returncode:  # this build lacks the library
                continue
            rng = random.Random(f"{seed} {what}")
            for i in range(count):
                how = {"FAIL_BYTES": str(rng.randint(peak // 20, peak))}
                if i % 2 and what not in ABORTS:
                    how = {"FAIL_AT": str(rng.randint(1, allocations))}
                faults = faults_of(words, folder, shim, how, before)
                tried, bad = tried + 1, bad + bool(faults)
                if faults:
                    print(f"{what}: {how} of {allocations} allocations, {peak} bytes: {shlex.join(words)}\n  "
                          + "\n  ".join(faults))
    print(f"{tried} runs, {bad} at fault")
    return 1 if bad or not tried else 0


if __name__ == "__main__":
    sys.exit(main())
