# SPDX-License-Identifier: MIT
"""Real editors with csgmesh lsp, set up by the lines of docs/editors.md. Skipped where the editor is not installed.

NVIM names Neovim's program, if it is not nvim.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
PROGRAM = os.environ["CSGMESH"]
PAGE = os.path.join(HERE, "../../docs/editors.md")
NVIM = shutil.which(os.environ.get("NVIM", "nvim"))
SCENES = {"main.scad": "use <wheel.scad>\ncub(3);\nwheel(r = 2);\n\n",
          "wheel.scad": "// A wheel with its axis along z.\nmodule wheel(r) cylinder(h = 1, r = r);\n"}


def line_for(editor):
    """What the table of the page says."""
    with open(PAGE, encoding="utf-8") as page:
        return re.search(rf"^\| {re.escape(editor)} \|.*?`(.*?)`", page.read(), re.M).group(1)


def version_of_neovim():
    said = subprocess.run([NVIM, "--version"], capture_output=True, text=True, check=True).stdout
    return tuple(map(int, re.match(r"NVIM v(\d+)\.(\d+)", said).groups()))


@unittest.skipUnless(NVIM, "no nvim")
class Neovim(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="csgmesh-editor-")
        self.addCleanup(holder.cleanup)
        self.folder = holder.name
        for name, text in SCENES.items():
            with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
                file.write(text)

    def run_headless(self, setup):
        with open(os.path.join(self.folder, "init.lua"), "w", encoding="utf-8") as file:
            file.write(setup + "\n")
        env = {**os.environ, "PATH": os.path.dirname(PROGRAM) + os.pathsep + os.environ["PATH"], "HOME": self.folder,
               "XDG_STATE_HOME": self.folder, "XDG_DATA_HOME": self.folder}
        result = subprocess.run([NVIM, "--headless", "--clean", "-u", "init.lua", "main.scad", "-S", os.path.join(HERE, "neovim.lua")],
                                cwd=self.folder, env=env, capture_output=True, text=True, timeout=600, check=False)
        said = result.stdout + result.stderr
        self.assertEqual(result.returncode, 0, said)
        return json.loads(next(line for line in said.splitlines() if line.startswith("{")))

    def test_what_people_do(self):
        editor = "Neovim 0.11" if version_of_neovim() >= (0, 11) else "Neovim 0.7"
        got = self.run_headless(line_for(editor))
        line, column, message = got["finding"]
        self.assertEqual((line, column), (1, 0))
        self.assertIn("did you mean 'cube'?", message)
        self.assertIn("A wheel with its axis along z.", got["hover"])
        self.assertEqual(got["definition"], ["wheel.scad", 2])
        self.assertEqual(got["completion"], ["wheel"])
        self.assertEqual(got["text"], ["use <wheel.scad>", "cube(3);", "disc(r = 2);", "translate([1, 2, 3]) disc(r = 1);"])


if __name__ == "__main__":
    if not NVIM:
        print("no editor is installed: Neovim (nvim, or NVIM)")
        sys.exit(77)
    unittest.main()
