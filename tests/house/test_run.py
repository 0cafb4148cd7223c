# SPDX-License-Identifier: MIT
"""tools/run: the first time it says what it did and how to look at the result, later it is silent; the program's exit
status is its own. Packages, meson and ninja are stand-ins.
"""
import os
import shutil
import subprocess
import tempfile
import unittest

TOOLS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools")
STAND_INS = {
    "apt-get": "exit 1",
    "dpkg-query": "printf installed",
    "pkg-config": "exit 0",
    "meson": 'mkdir -p "$2" && echo >"$2/build.ninja"',
    "ninja": 'mkdir -p "$2/tools/csgmesh"; cat >"$2/tools/csgmesh/csgmesh" <<"END"\n'
             '#!/bin/sh\n[ "$1" != version ] || { echo "csgmesh 9.8.7 (scalar)"; echo more; exit 0; }\n'
             'echo "asked for $*"\nexit "${WANTED:-0}"\nEND\nchmod +x "$2/tools/csgmesh/csgmesh"',
}


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        os.mkdir(os.path.join(self.folder, "tools"))
        for name in ("run", "setup.sh"):
            shutil.copy(os.path.join(TOOLS, name), os.path.join(self.folder, "tools"))
        os.mkdir(os.path.join(self.folder, "bin"))
        for name, body in STAND_INS.items():
            path = os.path.join(self.folder, "bin", name)
            with open(path, "w", encoding="utf-8") as file:
                file.write(f"#!/bin/sh\n{body}\n")
            os.chmod(path, 0o755)

    def run_it(self, *arguments, wanted="0"):
        path = os.path.join(self.folder, "bin") + os.pathsep + os.environ["PATH"]
        return subprocess.run([os.path.join(self.folder, "tools", "run"), *arguments], capture_output=True, text=True,
                              check=False, env={**os.environ, "PATH": path, "WANTED": wanted})

    def test_the_first_time_and_later(self):
        first = self.run_it("mug.txt", "-o", "mug glb")
        self.assertEqual((first.returncode, first.stdout), (0, "asked for mug.txt -o mug glb\n"), first.stderr)
        lines = first.stderr.splitlines()
        self.assertEqual(len(lines), 3, lines)
        self.assertIn("building csgmesh", lines[0])
        self.assertIn("csgmesh 9.8.7 (scalar)", lines[1])
        self.assertIn("tools/run view FILE", lines[2])
        later = self.run_it("help")
        self.assertEqual((later.returncode, later.stdout, later.stderr), (0, "asked for help\n", ""))

    def test_a_failure_is_the_programs(self):
        first = self.run_it("bad.txt", wanted="1")
        self.assertEqual(first.returncode, 1)
        self.assertNotIn("picture.png", first.stderr)
        self.assertEqual(self.run_it("bad.txt", wanted="2").returncode, 2)


if __name__ == "__main__":
    unittest.main()
