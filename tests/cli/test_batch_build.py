# SPDX-License-Identifier: MIT
"""Batches in build systems, by the real tools on a sample project: --emit ninja, make, meson and cmake,
and what is installed for projects: the CMake function, the rules for Make, the folder for Meson. Each is
built; nothing is done again; an include changes: what depends on it is made and nothing else.
"""
import os
import shutil
import subprocess
import unittest
import unittest.mock

import cli
from batch_support import BatchTest

SHARE = os.environ["CSGMESH_SHARE"]
WRAPPER = """#!/bin/sh
echo "$*" >>'{log}'
exec '{program}' "$@"
"""


def needs(*programs):
    missing = [name for name in programs if not shutil.which(name)]
    return unittest.skipIf(missing, f"not installed: {missing}")


class BuildTest(BatchTest):
    """A csgmesh that writes down each call stands first in PATH."""

    def setUp(self):
        super().setUp()
        self.scenes()
        os.mkdir(self.path("bin"))
        self.log = self.path("calls.log")
        self.write("bin/csgmesh", WRAPPER.format(log=self.log, program=cli.PROGRAM))
        os.chmod(self.path("bin/csgmesh"), 0o755)
        self.env = {**os.environ, "PATH": self.path("bin") + ":" + os.environ["PATH"]}
        for name in ("CSGMESH", "MAKEFLAGS", "MAKELEVEL", "NINJA_STATUS", "DESTDIR"):
            self.env.pop(name, None)

    def tool(self, *command, cwd="."):
        result = subprocess.run(command, cwd=self.path(cwd), env=self.env, capture_output=True,
                                text=True, check=False)
        self.assertEqual(result.returncode, 0, f"{command}\n{result.stdout}\n{result.stderr}")
        return result.stdout

    def calls(self, *command, cwd="."):
        """The scenes that the command has meshed."""
        if os.path.exists(self.log):
            os.remove(self.log)
        self.tool(*command, cwd=cwd)
        if not os.path.exists(self.log):
            return []
        with open(self.log, encoding="utf-8") as file:
            lines = [line for line in file.read().splitlines() if "--version" not in line]
        return sorted(os.path.basename(word) for line in lines
                      for word in line.split() if word.endswith(".txt"))

    def emit(self, system, *more, odd="a b$c"):
        self.write("parts.json", cli.json.dumps({"resolution": 10, "jobs": [
            {"scene": "mug.txt", "formats": ["glb", "stl"], "defines": {"radius": 3}},
            {"scene": "mug.txt", "parameter_file": "sets.json", "sets": "small"},
            {"scene": "box.txt", "name": "{scene}-{part}.{ext}"},
            {"scene": "ball.txt", "name": odd + ".{ext}"}]}))
        result = self.run_in("batch", "parts.json", "--emit", system, *more)
        self.assert_status(result, 0)
        return result.stdout.decode()

    WHOLE = ["ball.txt", "box.txt", "mug.txt", "mug.txt"]
    FILES = ["a b$c.glb", "box-box.glb", "box-lid.glb", "mug-small.glb", "mug.glb", "mug.stl"]

    def meshes(self, folder):
        return sorted(name for name in os.listdir(self.path(folder))
                      if name.endswith((".glb", ".stl", ".ply")))

    def check_incremental(self, *command, cwd=".", first, after_include):
        self.assertEqual(self.calls(*command, cwd=cwd), sorted(first))
        self.assertEqual(self.calls(*command, cwd=cwd), [], "a build without changes does something")
        self.write("lib/base.txt", "module base(r) cube(r);\n")
        self.assertEqual(self.calls(*command, cwd=cwd), sorted(after_include))
        self.assertEqual(self.calls(*command, cwd=cwd), [])
        self.write("lib/base.txt", "module base(r) cube(r); // a remark\n")
        self.assertEqual(self.calls(*command, cwd=cwd), sorted(after_include))
        self.assertEqual(self.calls(*command, cwd=cwd), [])


class Emitted(BuildTest):
    def test_roots_stay(self):
        """What the run may read and write is what its rules may."""
        leaks = os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"  # its look at /proc is refused, too
        self.env["ASAN_OPTIONS"] = leaks
        patch = unittest.mock.patch.dict(os.environ, ASAN_OPTIONS=leaks)
        patch.start()
        self.addCleanup(patch.stop)
        self.write("rules.ninja", self.emit("ninja", "-d", "out"))
        if "Landlock" in self.run_in("check", "mug.txt", "--root", ".").stderr:
            self.skipTest("no Landlock here")
        for system in ("ninja", "make"):
            self.assertNotIn("--root", self.emit(system, "-d", "out"))
            rules = self.emit(system, "-d", "out", "--root", ".")
            self.assertIn("--root=.", rules)
        if shutil.which("ninja"):
            self.write("build.ninja", self.emit("ninja", "-d", "out", "--root", "."))
            self.tool("ninja")
            self.assertEqual(self.meshes("out"), self.FILES)

    @needs("ninja")
    def test_ninja(self):
        self.write("build.ninja", self.emit("ninja", "-d", "out"))
        self.check_incremental("ninja", first=self.WHOLE, after_include=["mug.txt", "mug.txt"])
        self.assertEqual(self.meshes("out"), self.FILES)

    @needs("ninja")
    def test_ninja_rests_when_no_byte_changes(self):
        rules = self.emit("ninja", "-d", "out")
        self.write("build.ninja", rules + "\nrule copy\n  command = cp $in $out && echo x.txt >>"
                   + self.log + "\nbuild copy.glb: copy out/mug.glb\n")
        self.assertIn("x.txt", self.calls("ninja"))
        self.write("lib/base.txt", "module base(r) sphere(r); // a remark\n")
        self.assertEqual(self.calls("ninja"), ["mug.txt", "mug.txt"])
        self.assertEqual(self.calls("ninja"), [])

    @needs("make")
    def test_make(self):
        self.write("Makefile", self.emit("make", "-d", "out"))
        # blanks in names are beyond Make's include
        self.assertIn("out/a\\ b$$c.glb", self.read("Makefile").decode())
        self.check_incremental("make", "-j2", first=self.WHOLE,
                               after_include=["mug.txt", "mug.txt"])
        self.assertEqual(self.meshes("out"), self.FILES)

    @needs("cmake", "ninja", "make")
    def test_cmake(self):
        for generator in ("Ninja", "Unix Makefiles"):
            self.scenes()
            self.write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.21)\n"
                       "project(sample NONE)\n" + self.emit("cmake", "-d", "out", odd="a b"))
            build = "build-" + generator.split()[0]
            self.tool("cmake", "-G", generator, "-S", ".", "-B", build)
            self.check_incremental("cmake", "--build", build, first=self.WHOLE,
                                   after_include=["mug.txt", "mug.txt"])
            self.assertEqual(self.meshes(build + "/out"), ["a b.glb", *self.FILES[1:]])

    @needs("meson", "ninja")
    def test_meson(self):
        self.write("meson.build", "project('sample')\n" + self.emit("meson", "-d", "out"))
        self.tool("meson", "setup", "build")
        self.check_incremental("ninja", "-C", "build", first=self.WHOLE,
                               after_include=["mug.txt", "mug.txt"])
        self.assertEqual(self.meshes("build"), self.FILES)

    def test_what_cannot_be_said(self):
        result = self.run_in("batch", "mug.txt", "--emit", "meson", "--name", "x/{scene}.{ext}")
        self.assert_refused(result, 2, "Meson", "x/mug.glb")
        result = self.run_in("batch", "mug.txt", "--emit", "ninja", "-D", "a=1\n+1")
        self.assert_refused(result, 2, "line breaks")
        result = self.run_in("batch", "mug.txt", "--emit", "cmake", "--name", "a$b.{ext}")
        self.assert_refused(result, 2, "CMake", "a$b.glb")
        self.write("bad.txt", "sphere(;\n")
        result = self.run_in("batch", "bad.txt", "--emit", "make", "--name", "{part}.{ext}")
        self.assertEqual(result.returncode, 1)
        self.assertIn("bad.txt:1:8: error", result.stderr)


class Shipped(BuildTest):
    @needs("cmake", "ninja", "make")
    def test_cmake_function(self):
        self.write("CMakeLists.txt", """
cmake_minimum_required(VERSION 3.21)
project(sample NONE)
find_package(csgmesh REQUIRED)
csgmesh_add_mesh(mug ALL SCENE mug.txt FORMATS glb stl RESOLUTION 10 DEFINES radius=3 INCLUDE lib)
csgmesh_add_mesh(sets ALL SCENE mug.txt RESOLUTION 10 PARAMETER_FILE sets.json SETS small large
                 OUTPUT_DIRECTORY sets)
csgmesh_add_mesh(ball SCENE ball.txt NAME round OPTIONS -s 0.5 --ascii FORMATS ply)
get_property(files TARGET mug PROPERTY CSGMESH_OUTPUTS)
message(STATUS "outputs: ${files}")
""")
        for generator in ("Ninja", "Unix Makefiles"):
            self.scenes()
            build = "build-" + generator.split()[0]
            said = self.tool("cmake", "-G", generator, "-S", ".", "-B", build,
                             f"-Dcsgmesh_DIR={SHARE}/cmake",
                             # not one that happens to stand beside the checkout
                             f"-DCSGMESH_EXECUTABLE={self.path('bin/csgmesh')}")
            self.assertRegex(said, r"outputs: \S*/mug.glb;\S*/mug.stl")
            self.check_incremental("cmake", "--build", build, first=["mug.txt"] * 3,
                                   after_include=["mug.txt"] * 3)
            self.assertEqual(self.calls("cmake", "--build", build, "--target", "ball"),
                             ["ball.txt"])
            self.assertEqual(self.meshes(build), ["mug.glb", "mug.stl", "round.ply"])
            self.assertEqual(self.meshes(build + "/sets"), ["mug-large.glb", "mug-small.glb"])

    @needs("make")
    def test_make_rules(self):
        self.write("Makefile", "CSGMESH_MESHES = mug.glb mug.stl ball.ply\nCSGMESH_FLAGS = -r 10\n"
                   f"include {SHARE}/make/csgmesh.mk\n"
                   "ball.ply: CSGMESH_FLAGS += --ascii\n")
        self.check_incremental("make", first=["ball.txt", "mug.txt", "mug.txt"],
                               after_include=["mug.txt", "mug.txt"])
        self.assertTrue(self.read("ball.ply").startswith(b"ply\nformat ascii"))
        self.assertEqual(self.calls("make", "CSGMESH_OUT=out"),
                         ["ball.txt", "mug.txt", "mug.txt"])
        self.assertEqual(self.meshes("out"), ["ball.ply", "mug.glb", "mug.stl"])

    @needs("meson", "ninja")
    def test_meson_folder(self):
        shutil.copytree(os.path.join(SHARE, "meson/csgmesh"), self.path("csgmesh"))
        self.write("meson.build", "project('sample')\ncsgmesh_scenes = files('mug.txt', 'ball.txt')\n"
                   "csgmesh_formats = ['glb', 'stl']\ncsgmesh_options = ['-r', '10']\n"
                   "subdir('csgmesh')\nassert(csgmesh_meshes.length() == 2)\n")
        self.tool("meson", "setup", "build")
        self.check_incremental("ninja", "-C", "build", first=["ball.txt", "mug.txt"],
                               after_include=["mug.txt"])
        self.assertEqual(self.meshes("build/csgmesh"),
                         ["ball.glb", "ball.stl", "mug.glb", "mug.stl"])


if __name__ == "__main__":
    cli.main()
