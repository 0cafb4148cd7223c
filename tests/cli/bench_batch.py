# SPDX-License-Identifier: MIT
"""How fast csgmesh batch is: a thousand small scenes at -r 32, the same again, and one large scene alone
and among small ones. Prints figures, decides nothing.
"""
import os
import subprocess
import tempfile
import time

PROGRAM = os.environ["CSGMESH"]
SMALL = "union(blend = 0.2) {{\n  sphere(r = {a});\n  translate([1, {b}, 0]) cube({c});\n" \
        "  cylinder(h = {h}, r = 1);\n}}\n"
LARGE = "union(blend = 0.1) for (i = [0 : 199]) translate([i % 10, floor(i / 10), sin(77 * i)]) " \
        "sphere(r = 0.6);\n"


def timed(folder, *arguments):
    begin = time.monotonic()
    subprocess.run([PROGRAM, "batch", *arguments, "-q"], cwd=folder, check=True)
    return time.monotonic() - begin


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, "s"))
        for i in range(1000):
            with open(os.path.join(folder, f"s/a{i}.txt"), "w", encoding="utf-8") as file:
                file.write(SMALL.format(a=i % 7 + 1, b=i % 5, c=i % 3 + 2, h=1 + i / 100))
        with open(os.path.join(folder, "large.txt"), "w", encoding="utf-8") as file:
            file.write(LARGE)
        many = ["s/*.txt", "-d", "out", "-r", "32"]
        seconds = timed(folder, *many)
        print(f"1000 small scenes, all cores: {seconds:.2f} s, {1000 / seconds:.0f} a second")
        print(f"the same again: {timed(folder, *many):.3f} s")
        print(f"the same, forced, -j 1: {timed(folder, *many, '--force', '-j', '1'):.2f} s")
        for threads in ("1", "0"):
            more = ["-j", threads] if threads != "0" else []
            seconds = timed(folder, "large.txt", "-d", "l" + threads, "-r", "1200", *more)
            print(f"one large scene, {'one core' if more else 'all cores'}: {seconds:.2f} s")


if __name__ == "__main__":
    main()
