# SPDX-License-Identifier: MIT
"""--watch of mesh and batch: files are written again when one that they are made of changes, goes or comes.

Nothing here depends on how long that takes: each wait is for what must come, and ends with a failure after minutes.
"""
import json
import os
import signal
import subprocess
import time
import unittest
import unittest.mock

import cli

PATIENCE_S = 240


class Watched(cli.CliTest):
    def start(self, *arguments):
        with open(self.path("said"), "wb") as said:
            self.program = subprocess.Popen([cli.PROGRAM, *map(str, arguments), "--watch"], cwd=self.folder,
                                            stdout=said, stderr=subprocess.STDOUT)
        self.addCleanup(self.kill)

    def kill(self):
        if self.program.poll() is None:
            self.program.kill()
        self.program.wait()

    def end(self, number=signal.SIGINT):
        self.program.send_signal(number)
        self.assertEqual(self.program.wait(PATIENCE_S), 0, self.said())

    def said(self):
        return self.read("said").decode()

    def until(self, what, holds):
        begun = time.monotonic()
        while not holds():
            self.assertIsNone(self.program.poll(), f"it has ended: {self.said()}")
            self.assertLess(time.monotonic() - begun, PATIENCE_S, f"{what} does not come: {self.said()}")
            time.sleep(0.02)

    def width(self, name):
        """Of a PLY's solid; None: it is not there."""
        if not os.path.exists(self.path(name)):
            return None
        low, high = self.info(name)["mesh"]["bounds"]
        return round(high[0] - low[0], 3)

    def until_wide(self, width, name="main.ply"):
        self.until(f"{name} of width {width}", lambda: self.width(name) == width)

    def until_said(self, words, times=1):
        self.until(words, lambda: self.said().count(words) >= times)


class Mesh(Watched):
    def test_scene_and_includes(self):
        """A saved change, one of an include, a new file in the old one's place."""
        os.mkdir(self.path("lib"))
        self.write("lib/size.scad", "size = 10;\n")
        self.write("main.scad", "include <lib/size.scad>\ncube(size);\n")
        self.start("main.scad", "-o", "main.ply")
        self.until_wide(10)
        self.write("lib/size.scad", "size = 12;\n")
        self.until_wide(12)
        self.write("new", "include <lib/size.scad>\ncube(size + 1);\n")
        os.replace(self.path("new"), self.path("main.scad"))
        self.until_wide(13)
        self.end()

    def test_goes_and_comes_back(self):
        self.write("size.txt", "size = 10;\n")
        self.write("main.txt", "include <size.txt>\ncube(size);\n")
        self.start("main.txt", "-o", "main.ply")
        self.until_wide(10)
        os.remove(self.path("size.txt"))
        self.until_said("there is no file 'size.txt'")
        self.assertEqual(self.width("main.ply"), 10, "the last good file stays")
        self.write("size.txt", "size = 11;\n")
        self.until_wide(11)
        os.remove(self.path("main.txt"))
        self.until_said("main.txt: error")
        self.write("main.txt", "cube(5);\n")
        self.until_wide(5)
        self.end(signal.SIGTERM)

    def test_missing_file_of_a_lenient_scene_comes(self):
        """There the include that is missing is a warning, and the mesh is made without it."""
        self.write("main.scad", "include <later.scad>\ncube(4);\n")
        self.start("main.scad", "-o", "main.ply")
        self.until_wide(4)
        self.write("later.scad", "translate([6, 0, 0]) cube(4);\n")
        self.until_wide(10)
        self.end()

    def test_file_that_is_found_earlier(self):
        """What comes into a folder that is looked in first takes the place of what was found behind it."""
        for folder in ("first", "second"):
            os.mkdir(self.path(folder))
        self.write("second/size.txt", "size = 6;\n")
        self.write("main.txt", "include <size.txt>\ncube(size);\n")
        self.start("main.txt", "-o", "main.ply", "-I", "first", "-I", "second")
        self.until_wide(6)
        self.write("first/size.txt", "size = 7;\n")
        self.until_wide(7)
        self.end()

    def test_imported_mesh(self):
        self.write("block.txt", "cube(6);\n")
        self.assert_status(self.run_in("block.txt", "-o", "block.stl"), 0)
        self.write("main.txt", 'import("block.stl");\n')
        self.start("main.txt", "-o", "main.ply")
        self.until_wide(6)
        self.write("block.txt", "cube(8);\n")
        self.assert_status(self.run_in("block.txt", "-o", "block.stl"), 0)
        self.until_wide(8)
        self.end()

    def test_mesh_as_scene(self):
        """What `mesh` converts is followed as well."""
        self.write("a.txt", "cube(3);\n")
        self.run_in("a.txt", "-o", "a.stl")
        self.start("a.stl", "-o", "main.ply")
        self.until_wide(3)
        self.write("a.txt", "cube(4);\n")
        self.run_in("a.txt", "-o", "a.stl")
        self.until_wide(4)
        self.end()

    def test_long_work_is_given_up(self):
        """A change is taken although the work before it would take minutes; so is the end."""
        self.write("main.txt", cli.ENDLESS)
        self.start("main.txt", "-o", "main.ply", "--max-steps", "1e15")
        self.until_said("Ctrl-C")
        self.write("main.txt", "cube(5);\n")
        self.until_wide(5)
        self.write("main.txt", cli.BLEND)
        self.until("another mesh", lambda: self.width("main.ply") != 5)
        self.write("main.txt", cli.ENDLESS)
        self.end()
        self.assertFalse([name for name in os.listdir(self.folder) if name.endswith(".tmp")])

    @unittest.mock.patch.dict(os.environ, ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0")
    def test_confined(self):
        """Under --root, where the sanitizer's own search for leaks is refused."""
        self.write("main.txt", "cube(5);\n")
        self.start("main.txt", "-o", "main.ply", "--root", ".", "--sandbox")
        self.until_wide(5)
        self.write("main.txt", "cube(6);\n")
        self.until_wide(6)
        self.write("main.txt", cli.ENDLESS)
        self.write("main.txt", "cube(7);\n")
        self.until_wide(7)
        self.end()

    def test_nothing_changed(self):
        """Its own outputs beside the scene are no reason to begin again; what is saved while work begins is one more."""
        self.write("main.txt", "cube(1);\necho(1);\n")
        self.start("main.txt", "-o", "main.ply", "-M", "main.d", "--trace", "t.json")
        self.until_wide(1)
        for width in range(2, 12):
            self.write(f"other{width}.txt", "cube(1);\n")
            self.write("new", f"cube({width});\necho({width});\n")
            os.replace(self.path("new"), self.path("main.txt"))
            self.until_wide(width)
        self.end()
        for width in range(1, 12):
            self.assertLessEqual(self.said().count(f"ECHO: {width}\n"), 2, self.said())


class Batch(Watched):
    def test_scenes(self):
        """A change makes what depends on it; a new scene that the pattern names is made as well."""
        os.mkdir(self.path("in"))
        self.write("size.txt", "size = 2;\n")
        self.write("in/a.txt", "include <../size.txt>\ncube(size);\n")
        self.write("in/b.txt", "cube(3);\n")
        self.start("batch", "in/*.txt", "-d", "in", "-f", "ply")
        self.until_wide(2, "in/a.ply")
        self.until_wide(3, "in/b.ply")
        self.write("size.txt", "size = 4;\n")
        self.until_wide(4, "in/a.ply")
        self.write("in/c.txt", "cube(6);\n")
        self.until_wide(6, "in/c.ply")
        self.write("in/b.txt", "cube(;\n")
        self.until_said("failed: in/b.txt")
        self.write("in/b.txt", "cube(7);\n")
        self.until_wide(7, "in/b.ply")
        self.end()

    def test_manifest(self):
        self.write("a.txt", "w = 2;\ncube(w);\n")
        self.write("sets.json", json.dumps({"fileFormatVersion": "1", "parameterSets": {"big": {"w": "5"}}}))
        self.write("parts.json", json.dumps({"directory": "out", "jobs": [{"scene": "a.txt", "formats": ["ply"]}]}))
        self.start("batch", "parts.json")
        self.until_wide(2, "out/a.ply")
        self.write("parts.json", json.dumps({"directory": "out", "jobs": [
            {"scene": "a.txt", "formats": ["ply"], "parameter_file": "sets.json", "sets": ["big"]}]}))
        self.until_wide(5, "out/a-big.ply")
        self.write("sets.json", json.dumps({"fileFormatVersion": "1", "parameterSets": {"big": {"w": "6"}}}))
        self.until_wide(6, "out/a-big.ply")
        self.write("parts.json", "{")
        self.until_said("parts.json")
        self.end()


class Faults(cli.CliTest):
    def test_command_line(self):
        """What no change of a file would mend ends it at once."""
        self.write("a.txt", cli.BALL)
        for status, words, arguments in (
                (2, "no scene given", ["-o", "a.ply"]), (2, "standard input", ["-", "-o", "a.ply"]),
                (2, "standard output", ["a.txt", "-f", "ply", "-o", "-"]), (2, "tells no format", ["a.txt", "-o", "a.nothing"]),
                (2, "no-such-folder", ["a.txt", "-o", "no-such-folder/a.ply"]),
                (2, "--emit", ["batch", "a.txt", "-d", "out", "--emit", "make"]),
                (2, "no directory", ["batch", "a.txt"])):
            with self.subTest(arguments):
                self.assert_refused(self.run_in(*arguments, "--watch", "-q"), status, words)
        self.assert_files("a.txt")


if __name__ == "__main__":
    cli.main()
