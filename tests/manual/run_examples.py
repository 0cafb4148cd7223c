#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs every ```csgmesh block of a Markdown file through `csgmesh check -Werror`.

    run_examples.py CSGMESH FILE.md

A block that opens with ```csgmesh file=NAME is only saved under that name, for later blocks to include
or use. The test fails when there is no block at all, so that a renamed fence is noticed.
"""
import os
import re
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```csgmesh(?: file=(\S+))?\n(.*?)^```$", re.M | re.S)


def main():
    program, manual = sys.argv[1:]
    with open(manual, encoding="utf-8") as file:
        text = file.read()
    failures = count = 0
    with tempfile.TemporaryDirectory() as folder:
        for block in BLOCK.finditer(text):
            count += 1
            line = text.count("\n", 0, block.start()) + 2
            path = os.path.join(folder, block.group(1) or f"line-{line}.txt")
            with open(path, "w", encoding="utf-8") as file:
                file.write(block.group(2))
            if block.group(1):
                continue
            run = subprocess.run([program, "check", "-Werror", path], capture_output=True, text=True,
                                 check=False)
            if run.returncode:
                failures += 1
                print(f"{manual}:{line}: this example fails (status {run.returncode}):\n{run.stderr}")
    print(f"{count} examples, {failures} failed")
    return 1 if failures or not count else 0


if __name__ == "__main__":
    sys.exit(main())
