# SPDX-License-Identifier: MIT
"""csgmesh format: files in place, --check, standard input, what it refuses, and the scenes of this project."""
import glob
import os
import unittest

import cli

LOOSE = "cube( [1,2,3],center=true );\n"
NEAT = "cube([1, 2, 3], center = true);\n"


class Format(cli.CliTest):
    def test_in_place(self):
        self.write("a.txt", LOOSE)
        self.write("b.scad", NEAT)
        before = os.stat(self.path("b.scad"))
        result = cli.run("format", "a.txt", "b.scad", cwd=self.folder)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, b"", ""))
        self.assertEqual(self.read("a.txt"), NEAT.encode())
        after = os.stat(self.path("b.scad"))
        self.assertEqual((before.st_ino, before.st_mtime_ns), (after.st_ino, after.st_mtime_ns))

    def test_check_writes_nothing(self):
        self.write("a.txt", LOOSE)
        self.write("b.txt", NEAT)
        result = cli.run("format", "--check", "a.txt", "b.txt", cwd=self.folder)
        self.assertEqual((result.returncode, result.stdout), (1, b"a.txt\n"))
        self.assertEqual(self.read("a.txt"), LOOSE.encode())
        self.assertEqual(cli.run("format", "--check", "b.txt", cwd=self.folder).returncode, 0)
        self.assertEqual(cli.run("format", "--check", "-", stdin=LOOSE.encode()).stdout, b"standard input\n")

    def test_standard_input(self):
        result = cli.run("format", "-", stdin=LOOSE.encode())
        self.assertEqual((result.returncode, result.stdout), (0, NEAT.encode()))

    def test_refusals(self):
        self.write("a.txt", "cube(1;\n")
        os.mkdir(self.path("folder"))
        result = cli.run("format", "a.txt", cwd=self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("a.txt:1:7: error E0109", result.stderr)
        self.assertEqual(self.read("a.txt"), b"cube(1;\n")
        for name, words in (("none.txt", "No such file"), ("folder", "this is a directory")):
            result = cli.run("format", name, cwd=self.folder)
            self.assertEqual(result.returncode, 2)
            self.assertIn(words, result.stderr)
        self.assertIn("no scene given", cli.run("format").stderr)

    def test_links_stay_links(self):
        self.write("a.txt", LOOSE)
        os.symlink("a.txt", self.path("link.txt"))
        self.assertEqual(cli.run("format", "link.txt", cwd=self.folder).returncode, 0)
        self.assertEqual(self.read("a.txt"), NEAT.encode())
        self.assertTrue(os.path.islink(self.path("link.txt")))

    def test_scenes_of_this_project(self):
        scenes = [path for path in glob.glob(os.path.join(cli.SCENES, "**", "*.txt"), recursive=True)
                  if os.path.basename(os.path.dirname(path)) != "bad"]
        self.assertGreater(len(scenes), 50)
        result = cli.run("format", "--check", *scenes)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, b"", ""))


if __name__ == "__main__":
    unittest.main()
