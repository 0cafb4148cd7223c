# SPDX-License-Identifier: MIT
"""tools/integrations/bazel by the real bazel, where it is installed: what csgmesh_mesh makes are the bytes of csgmesh mesh,
nothing is made twice, and a file that is not named among deps is not there.
"""
import ast
import os
import shutil
import subprocess
import tempfile
import unittest

import cli
from test_batch_build import SHARE, BuildTest, WRAPPER, needs

RULES = os.path.join(SHARE, "bazel", "csgmesh")


class Syntax(unittest.TestCase):
    """Starlark's syntax is a part of Python's: also of the file that old versions of bazel do not load."""

    def test_each_file(self):
        for name in ("csgmesh.bzl", "extensions.bzl", "BUILD.bazel", "MODULE.bazel", "WORKSPACE"):
            with open(os.path.join(RULES, name), encoding="utf-8") as file:
                ast.parse(file.read(), name)


@needs("bazel")
class Bazel(BuildTest):
    def setUp(self):
        super().setUp()
        self.env.pop("CC", None)  # bazel takes a path, no command of several words
        logs = tempfile.TemporaryDirectory()
        self.addCleanup(logs.cleanup)
        self.log = os.path.join(logs.name, "calls.log")
        self.write("bin/csgmesh", WRAPPER.format(log=self.log, program=cli.PROGRAM))
        root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, root)
        self.addCleanup(self.tool, "chmod", "-R", "u+w", root)
        self.bazel = ["bazel", f"--output_user_root={root}", "--max_idle_secs=60"]
        self.addCleanup(self.tool, *self.bazel, "shutdown")
        self.write_project()

    def write_project(self, deps='["lib/base.txt"]'):
        self.write("WORKSPACE", f"""
workspace(name = "sample")
local_repository(name = "rules_csgmesh", path = "{RULES}")
load("@rules_csgmesh//:csgmesh.bzl", "csgmesh_local")
csgmesh_local(name = "csgmesh", path = "{self.path("bin/csgmesh")}")
""")
        self.write("BUILD.bazel", f"""
load("@rules_csgmesh//:csgmesh.bzl", "csgmesh_mesh")
csgmesh_mesh(name = "mug", scene = "mug.txt", deps = {deps}, formats = ["glb", "stl"], resolution = 10,
             defines = {{"radius": "3"}})
csgmesh_mesh(name = "sets", scene = "mug.txt", deps = {deps}, parameter_file = "sets.json", sets = ["small", "large"],
             resolution = 10, out = "cup")
csgmesh_mesh(name = "ball", scene = "ball.txt", formats = ["ply"], options = ["-s", "0.5", "--ascii"], threads = 2)
csgmesh_mesh(name = "found", scene = "finds.txt", deps = {deps} + ["made.txt"], includes = ["lib", "."], resolution = 10)
genrule(name = "made", outs = ["made.txt"], cmd = "echo 'made = 2;' > $@")
genrule(name = "finds", outs = ["finds.txt"], cmd = "echo 'include <base.txt> include <made.txt> base(made);' > $@")
genrule(name = "peek", outs = ["peek.txt"], cmd = "cat lib/base.txt > $@")
filegroup(name = "all", srcs = [":mug", ":sets", ":ball", ":found"])
""")

    def build(self, *targets):
        return self.calls(*self.bazel, "build", "--noshow_progress", f"--sandbox_writable_path={os.path.dirname(self.log)}",
                          *targets)

    def test_whole(self):
        self.assertEqual(self.build("//:all"), ["ball.txt", "finds.txt", "mug.txt", "mug.txt", "mug.txt"])
        made = "bazel-bin"
        for name, arguments in (("mug.glb", ["mug.txt", "-r", "10", "-D", "radius=3"]),
                                ("mug.stl", ["mug.txt", "-r", "10", "-D", "radius=3"]),
                                ("cup-small.glb", ["mug.txt", "-r", "10", "-p", "sets.json", "-P", "small"]),
                                ("cup-large.glb", ["mug.txt", "-r", "10", "-p", "sets.json", "-P", "large"]),
                                ("ball.ply", ["ball.txt", "-s", "0.5", "--ascii"])):
            self.run_in(*arguments, "-o", name)
            self.assertEqual(self.read(f"{made}/{name}"), self.read(name), name)
        self.assertTrue(os.path.exists(self.path(f"{made}/found.glb")))
        self.assertEqual(self.build("//:all"), [], "a build without changes does something")
        self.write("lib/base.txt", "module base(r) cube(r);\n")
        self.assertEqual(self.build("//:all"), ["finds.txt", "mug.txt", "mug.txt", "mug.txt"])
        # another program is another input
        self.write("bin/csgmesh", WRAPPER.format(log=self.log, program=cli.PROGRAM) + "# newer\n")
        self.tool(*self.bazel, "sync", "--configure")
        self.assertEqual(len(self.build("//:all")), 5)
        # what deps does not name is not there
        self.write_project(deps="[]")
        if self.try_to_build("//:peek").returncode == 0:
            self.skipTest("bazel has no sandbox here")
        failed = self.try_to_build("//:mug")
        self.assertNotEqual(failed.returncode, 0)
        self.assertIn("lib/base.txt", failed.stderr)

    def try_to_build(self, target):
        return subprocess.run([*self.bazel, "build", "--noshow_progress", target], cwd=self.folder, env=self.env,
                              capture_output=True, text=True, check=False)


if __name__ == "__main__":
    cli.main()
