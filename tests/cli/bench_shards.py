# SPDX-License-Identifier: MIT
"""What shards and caches of csgmesh batch cost and save, in processor time: a batch of scenes of very different sizes by one
machine and by eight, shared out by number and by the times of the report before; taken from a folder, and from an HTTP
server (nginx, where it is installed). Prints figures, the median of three runs each; decides nothing.
"""
import json
import os
import shutil
import statistics
import subprocess
import tempfile
import time

import nginx

PROGRAM = os.environ["CSGMESH"]
TEXT = "union(blend = 0.2) {{\n  sphere(r = {a});\n  translate([1, {b}, 0]) cube({c});\n  cylinder(h = {h}, r = 1);\n}}\n"
COUNT, SHARDS, RUNS = 400, 8, 3


def used(folder, *arguments, output=None):
    """Processor seconds of one run."""
    with open(os.path.join(folder, output) if output else os.devnull, "wb") as file:
        process = subprocess.Popen([PROGRAM, "batch", "parts.json", *arguments], cwd=folder, stdout=file)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, arguments
    return usage.ru_utime + usage.ru_stime


def median(run):
    return statistics.median(run() for _ in range(RUNS))


def fresh(folder, *arguments, output=None):
    shutil.rmtree(os.path.join(folder, "out"), ignore_errors=True)
    return used(folder, "-d", "out", *arguments, output=output)


def write(folder):
    """A tenth of the scenes takes most of the time."""
    jobs = []
    os.mkdir(os.path.join(folder, "s"))
    for i in range(COUNT):
        name = f"s/a{i}.txt"
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(TEXT.format(a=i % 7 + 1, b=i % 5, c=i % 3 + 2, h=1 + i / 100))
        jobs.append({"scene": name, "resolution": 160 if i % 10 == 0 else 24})
    with open(os.path.join(folder, "parts.json"), "w", encoding="utf-8") as file:
        json.dump(jobs, file)


def shards(folder):
    one = median(lambda: fresh(folder, "--json", output="report.json"))
    print(f"{COUNT} scenes, one machine: {one:.2f} s of processor time")
    for name, more in (("by number", []), ("by time", ["--times", "report.json"])):
        shares = [median(lambda i=i: fresh(folder, "--shard", f"{i + 1}/{SHARDS}", *more)) for i in range(SHARDS)]
        print(f"{SHARDS} shards, {name}: {sum(shares):.2f} s together, the largest {max(shares):.2f} s, "
              f"{max(shares) / (sum(shares) / SHARDS):.2f} of the average")


def caches(folder):
    address, server = nginx.serve(folder) if nginx.PROGRAM else (None, None)
    for name, cache in (("a folder", "cache"), ("nginx", address)):
        if not cache:
            continue
        fill = fresh(folder, "--cache", cache)
        taken = median(lambda cache=cache: fresh(folder, "--cache", cache))
        begin = time.monotonic()
        fresh(folder, "--cache", cache)
        print(f"{name}: filled in {fill:.2f} s of processor time, taken in {taken:.3f} s ({time.monotonic() - begin:.2f} s "
              "by the clock)")
    size = sum(os.path.getsize(os.path.join(place, name)) for place, _, names in os.walk(os.path.join(folder, "out"))
               for name in names if name.endswith(".glb"))
    print(f"the meshes have {size / 2**20:.1f} MiB")
    if server:
        server.terminate()
        server.wait()


def main():
    with tempfile.TemporaryDirectory() as folder:
        write(folder)
        shards(folder)
        caches(folder)


if __name__ == "__main__":
    main()
