#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Adds up meson's test logs (one JSON object per line) into "N passed, N failed, N skipped".

Exit status 1 when a test failed, or when none passed at all.
"""
import json
import os
import sys

PASSED = {"OK", "EXPECTEDFAIL"}
SKIPPED = {"SKIP", "IGNORED"}


def main():
    passed = failed = skipped = 0
    for path in sys.argv[1:]:
        if not os.path.exists(path):
            continue  # a suite without tests leaves no log
        with open(path, encoding="utf-8") as file:
            results = [json.loads(line)["result"] for line in file if line.strip()]
        passed += sum(result in PASSED for result in results)
        skipped += sum(result in SKIPPED for result in results)
        failed += sum(result not in PASSED | SKIPPED for result in results)
    print(f"{passed} passed, {failed} failed, {skipped} skipped")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
