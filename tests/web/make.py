# SPDX-License-Identifier: MIT
"""What the tests of this folder try: made anew by tools/web where it is out of date."""
import os
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def make(script):
    """The file that a script of tools/web has made; tests are skipped where it lacks something."""
    done = subprocess.run([sys.executable, os.path.join(ROOT, "tools", "web", script)], capture_output=True, text=True, check=False)
    if done.returncode == 77:
        raise unittest.SkipTest(done.stderr.strip())
    if done.returncode:
        raise AssertionError(done.stdout + done.stderr)
    return done.stdout.strip()
