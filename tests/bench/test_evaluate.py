#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A million solids are evaluated in under 1 GB and, on a quiet machine, 3 s of processor time
(evaluate.txt).

Usage: test_evaluate.py CSGMESH [--time]: time decides only with --time, in the benchmark. Exit
status 77, a skip, where sanitizers make both mean nothing.
"""
import os
import resource
import subprocess
import sys

SECONDS, MEGABYTES = 3.0, 1000

if os.environ.get("CSGMESH_SANITIZED") == "1":
    sys.exit(77)
scene = os.path.join(os.path.dirname(os.path.abspath(__file__)), "evaluate.txt")
subprocess.run([sys.argv[1], "check", scene], check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
seconds, megabytes = used.ru_utime + used.ru_stime, used.ru_maxrss / 1000
print(f"{seconds:.2f} s of processor time, {megabytes:.0f} MB")
is_quick = "--time" not in sys.argv or seconds < SECONDS
sys.exit(0 if is_quick and megabytes < MEGABYTES else 1)
