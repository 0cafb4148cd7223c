# SPDX-License-Identifier: MIT
"""What the command-line tests share: running the program in an empty folder and looking at what is left.

The program is named by the environment variable CSGMESH, the folder of scenes by CSGMESH_SCENES.
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ["CSGMESH"]
SCENES = os.environ["CSGMESH_SCENES"]

# A decorator of tests that only have more cubes, triangles or scenes than the others: with sanitizers they take five to ten
# times as long and look at the same code.
SANITIZED = os.environ.get("CSGMESH_SANITIZED") == "1"
optimised_only = unittest.skipIf(SANITIZED, "the optimised build has it")


def rounds(count):
    """Of a random search, as ROUNDS of tests/rounds.h: all, a quarter with sanitizers."""
    return (count + 3) // 4 if SANITIZED else count


# For csgmesh diff, whose 262 144 samples and rays by default take longer than small meshes' proven bounds, by which verdicts go.
FEW_SAMPLES = ("--samples", "10000")

BALL = "sphere(r = 1);\n"
ENDLESS = "for (i = [0 : 99999]) for (j = [0 : 99999]) if (i < 0) sphere(i);\n"
BLEND = """union(blend = 0.3) {
  sphere(r = 1);
  translate([0.9, 0, 0]) color("red") cube(0.8);
}
"""


def run(*arguments, cwd=None, stdin=b"", env=None, timeout=300, stdout=subprocess.PIPE):
    """Runs the program; stdout stays bytes, stderr becomes text."""
    result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, input=stdin, stdout=stdout,
                            stderr=subprocess.PIPE, timeout=timeout, check=False,
                            env={**os.environ, **(env or {})})
    result.stderr = result.stderr.decode("utf-8", "replace")
    return result


def formats_written():
    """The formats that this build can write, as its own message lists them."""
    message = run("x.txt", "-o", "-").stderr
    return message.split("formats:")[1].split()


def formats_read():
    """Those of them that can be read, too: by the rows of the table, and by what this build lacks."""
    sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "tools", "manual"))
    from tables import format_rows  # pylint: disable=import-outside-toplevel
    ways = {name: way for name, _, way, _, _ in format_rows()}
    return [name for name in formats_written() if ways[name] != "WRITE_ONLY"
            and (has_library("tinygltf") or name not in ("gltf", "glb"))]


def has_library(name):
    """Whether this build has the optional library, as its own version says."""
    lines = run("--version").stdout.decode().splitlines()
    return any(line.startswith("with ") and name in line for line in lines)


def hidden_name(number):
    """What a run on this machine calls a file that has no name yet (io/temporary.h)."""
    host = 2166136261
    for byte in os.uname().nodename.encode():
        host = (host ^ byte) * 16777619 & 0xFFFFFFFF
    return f".csgmesh-{host:08x}-{os.getpid()}-{number:x}-0.tmp"


class CliTest(unittest.TestCase):
    """Each test stands in an empty folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return name

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def run_in(self, *arguments, **options):
        return run(*arguments, cwd=self.folder, **options)

    def assert_files(self, *names):
        """These files and no others are in the folder."""
        self.assertEqual(sorted(os.listdir(self.folder)), sorted(names))

    def assert_status(self, result, status):
        self.assertEqual(result.returncode, status,
                         f"{' '.join(result.args)}\n{result.stderr}")

    def assert_clean(self, result):
        """No sanitizer report, no crash."""
        self.assertGreaterEqual(result.returncode, 0, result.stderr)
        for word in ("Sanitizer", "runtime error", "Assertion"):
            self.assertNotIn(word, result.stderr)

    def assert_refused(self, result, status, *words):
        """This exit status, a message of a few lines with these words, nothing on stdout."""
        self.assert_clean(result)
        self.assert_status(result, status)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertTrue(result.stderr.strip(), "no message")
        self.assertLess(len(result.stderr.splitlines()), 8, result.stderr)
        self.assertFalse(result.stdout)

    def stats(self, *arguments):
        result = self.run_in(*arguments, "--stats")
        self.assert_status(result, 0)
        return json.loads(result.stdout)

    def info(self, name):
        result = self.run_in("info", "--json", name)
        self.assert_status(result, 0)
        return json.loads(result.stdout)


def main():
    """Like unittest.main, with exit status 77 (a skip) when every test was skipped."""
    program = unittest.main(exit=False)
    result = program.result
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if result.testsRun and len(result.skipped) == result.testsRun else 0)
