# SPDX-License-Identifier: MIT
"""csgmesh diff: verdicts and exit statuses, reports, folders, --update, heat maps, git difftool.

With --thorough: sampled distances of scipy (where it is there) are never above the proven bounds.
"""
import json
import os
import shutil
import subprocess
import sys
import unittest
import xml.dom.minidom

import cli
import diff_support

BALL = "sphere(10);\n"
KNOB = "sphere(10); translate([10, 0, 0]) sphere(2);\n"


class Diff(diff_support.DiffTest):
    def test_levels(self):
        self.mesh(BALL, "a.ply")
        shutil.copy(self.path("a.ply"), self.path("b.ply"))
        self.assertIn(b"the same bytes", self.diff(0, "a.ply", "b.ply").stdout)
        self.mesh(BALL, "a.stl")
        self.assertIn(b"the same triangles", self.diff(0, "a.ply", "a.stl").stdout)
        self.mesh("sphere(10.05);", "c.ply")
        self.assertEqual(self.report(0, "a.ply", "c.ply", "--tol", "0.1")["level"],
                         "within tolerance")
        result = self.diff(1, "a.ply", "c.ply", "--tol", "0.01")
        lines = [line.split()[0] for line in result.stdout.decode().splitlines()]
        self.assertEqual(lines, ["different:", "size", "volume", "material", "area", "distance"])
        self.diff(0, "a.ply", "c.ply", "--tol-rel", "1%")
        self.assertIn(b"volumes within the tolerance, at most",
                      self.diff(0, "a.ply", "c.ply", "--tol-volume", "2%").stdout)
        self.diff(1, "a.ply", "c.ply", "--tol-volume", "1%")
        self.assertEqual(self.diff(1, "-q", "a.ply", "c.ply").stdout, b"")

    def test_scene_against_mesh(self):
        self.mesh(BALL, "golden.ply")
        self.write("ball.txt", BALL)
        self.diff(0, "golden.ply", "ball.txt", "-r", 32)
        report = self.report(0, "golden.ply", "ball.txt", "-r", 64, "--tol", "0.1", "--field")
        field = report["a_to_field_of_b"]
        self.assertEqual(field["lambda"], 1)
        # facets of an inscribed polyhedron: their middles are off, the sagitta of a cell at most
        self.assertGreater(field["distance_lower"], 0.003)
        self.assertLess(field["distance_upper"], 0.1)
        self.assertLessEqual(field["distance_lower"], field["distance_upper"])
        self.write("knob.txt", KNOB)
        self.assertIn(b"apart", self.diff(1, "golden.ply", "knob.txt", "-r", 64, "--tol", "0.1").stdout)
        self.diff(0, "golden.ply", "ball.txt", "-D", "unused=1", "-r", 32)
        self.assert_refused(self.run_in("diff", "golden.ply", "golden.ply", "--field"), 2, "--field")

    def test_scene_against_its_own_file(self):
        """As the file was made: its format's rounding, colours and normals, and what is asked for."""
        parts = ('part("a") color("red") difference(blend = 1) { cube(10); translate([10, 10, 10]) sphere(4); } '
                 'part("b") translate([8, 2, 2]) color([0.2, 0.4, 0.6, 0.5]) cylinder(h = 9, r = 2);\n')
        formats = cli.formats_read()
        ways = [(name, "--normals", "auto") for name in formats]
        ways += [(name, "--normals", normals) for name in {"obj", "glb"} & set(formats) for normals in ("vertex", "none")]
        ways += [("glb", "--draco"), ("gltf", "--draco")] if "drc" in formats else []
        if cli.has_library("meshoptimizer") and cli.has_library("tinygltf"):
            ways += [("glb", "--compress=meshopt"), ("gltf", "--compress=meshopt"), ("glb", "--compress=meshopt-khr")]
        for extension, *options in ways:
            self.write("s.txt", parts)
            self.assert_status(self.run_in("s.txt", "-q", "-r", "24", "-o", "s." + extension, *options), 0)
            self.assertIn(b"the same triangles", self.diff(0, "s." + extension, "s.txt", "-r", "24").stdout, options)
        self.assert_status(self.run_in("s.txt", "-q", "--unit", "mm", "-o", "u.glb", "-e", "0.1"), 0)
        self.diff(0, "u.glb", "s.txt", "--unit", "mm", "-e", "0.1")
        self.diff(0, "u.glb", "s.txt", "--unit", "in", "-e", "0.1") # the file says what its unit was
        for extension in ("ply", "stl"):
            self.assert_status(self.run_in("s.txt", "-q", "-o", "q." + extension, "--quality", "draft"), 0)
            self.diff(0, "q." + extension, "s.txt", "--quality", "draft")
        self.assert_status(self.run_in("s.txt", "-q", "-o", "both.stl", "-o", "both.ply", "--quality", "draft"), 0)
        self.diff(0, "both.stl", "s.txt", "--quality", "draft") # colours kept its triangles apart
        self.assert_status(self.run_in("s.txt", "-q", "-r", "24", "-o", "v.glb", "--normals", "vertex"), 0)
        self.assertIn(b"normals differ", self.diff(1, "v.glb", "s.txt", "-r", "24", "--normals", "crease").stdout)
        self.assertIn(b"colours differ", self.diff(1, "s.ply", "s.txt", "-r", "24", "--colors", "none").stdout)

    @cli.optimised_only
    def test_two_scenes_get_one_tolerance(self):
        """The smaller of theirs, at most a quarter of --tol, at least that of --quality fine; equal cells are as asked for."""
        small = "cube(10); translate([5, 5, 9.5]) sphere(1);\n"
        self.write("a.txt", small)
        self.write("b.txt", small + "translate([15, 5, 5]) cube([10, 3, 3], center = true);\n")

        def triangles(*options, a="a.txt", b="b.txt"):
            report = self.report(1, a, b, *options)
            return [report[side]["triangles"] for side in "ab"]

        def alone(name, *options):
            result = self.run_in("info", name, "--json", *options)
            return json.loads(result.stdout)["mesh"]["triangles"]
        draft = ["--quality", "draft"]
        a, b = triangles(*draft)
        self.assertEqual(a, alone("a.txt", *draft))
        self.assertGreater(b, alone("b.txt", *draft))  # b is twice as large, its own tolerance too
        self.assertEqual(triangles(*draft, "--tol", "0.5"), [a, b])
        self.assertGreater(triangles(*draft, "--tol", "0.05")[0], a)
        finest = triangles(*draft, "--tol", "1e-6")
        self.assertEqual(finest[0], alone("a.txt", "--quality", "fine"))
        self.assertEqual(triangles(*draft, "--tol-rel", "1e-7"), finest)
        for options in (["-r", "24"], ["-e", "0.1"]):
            self.assertEqual(triangles(*options, "--tol", "0.05"), [alone(name, *options) for name in ("a.txt", "b.txt")])
        self.assert_status(self.run_in("a.txt", "-q", "-o", "a.ply", *draft), 0)  # one mesh: as ever
        self.assertEqual(triangles(*draft, "--tol", "0.05", a="a.ply")[1], alone("b.txt", *draft))

    def test_timeout(self):
        """However little time there is: it ends with the limit's message, in any stage."""
        self.mesh(BALL, "a.ply")
        self.mesh("translate([0.003, 0, 0]) sphere(10.1);", "b.ply")
        for limit in ("1e-9", "0.001"):
            self.assertRegex(self.diff(2, "a.ply", "b.ply", "--timeout", limit).stderr,
                             "E0902: (comparing took longer than the limit of|reading the mesh takes more than) "
                             + limit.replace("1e-9", "1e-09"))

    def test_one_sided(self):
        self.mesh(BALL, "a.ply")
        self.mesh(KNOB, "b.ply")
        self.diff(1, "a.ply", "b.ply", "--tol", "0.2", "--one-sided", "added")
        self.diff(0, "a.ply", "b.ply", "--tol", "0.2", "--one-sided", "removed")
        self.diff(1, "b.ply", "a.ply", "--tol", "0.2", "--one-sided", "removed")

    def test_reports(self):
        self.mesh(BALL, "a.ply")
        self.mesh(KNOB, "b.ply")
        outputs = {}
        for threads in (1, 3):
            self.diff(1, "a.ply", "b.ply", "-j", threads, "--json", "o.json", "--junit", "o.xml",
                      "--heatmap", "h.ply", "--samples", 5000)
            outputs[threads] = [self.read(n) for n in ("o.json", "o.xml", "h.ply")]
        self.assertEqual(outputs[1], outputs[3])
        report = json.loads(outputs[1][0])
        self.assertEqual((report["verdict"], report["reasons"]), ("different", ["distance"]))
        lower, upper = report["hausdorff"]
        self.assertTrue(1.9 < lower <= upper <= 1.01 * lower, report["hausdorff"])
        self.assertAlmostEqual(report["b_to_a"]["worst"][0]["at"][0], 12, delta=0.1)
        case = xml.dom.minidom.parseString(outputs[1][1]).getElementsByTagName("failure")
        self.assertEqual(len(case), 1)
        self.assertIn(b"comment distance from the other mesh", outputs[1][2][:400])
        self.assertIn("with colours", self.run_in("info", "h.ply").stdout.decode())
        self.diff(1, "a.ply", "b.ply", "--heatmap", "h.glb")
        self.assertIn(b'"comment":"distance', self.read("h.glb")[:4096])

    def test_attributes(self):
        self.mesh('color("red") sphere(10);', "a.ply")
        self.mesh('color("blue") sphere(10);', "b.ply")
        self.assertIn(b"colours differ", self.diff(1, "a.ply", "b.ply").stdout)
        self.diff(0, "a.ply", "b.ply", "--ignore", "order,colors")
        self.mesh('part("lid") sphere(10);', "a.obj")
        self.mesh('part("cap") sphere(10);', "b.obj")
        self.assertIn(b"names", self.diff(1, "a.obj", "b.obj").stdout)
        self.diff(0, "a.obj", "b.obj", "--ignore", "names")
        self.diff(0, "a.obj", "a.ply", "--ignore", "colors")

    def test_topology_and_open_meshes(self):
        self.mesh("difference() { cube(10); translate([4, 4, -1]) cube([2, 2, 12]); }", "a.ply")
        self.mesh("difference() { cube(10); translate([4, 4, 2]) cube([2, 2, 12]); }", "b.ply")
        self.assertIn(b"genus 1 became 0", self.diff(1, "a.ply", "b.ply", "--tol", 20).stdout)
        self.diff(0, "a.ply", "b.ply", "--tol", 20, "--ignore-topology")
        self.write("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        result = self.diff(1, "a.ply", "open.off")
        self.assertIn(b"  open      0 -> 3 boundary edges", result.stdout)
        self.assertIn(b"not compared: B is open", result.stdout)
        self.assertNotIn(b"non-manifold", result.stdout)
        self.write("empty.off", "OFF\n0 0 0\n")
        self.assertIn(b"empty", self.diff(1, "a.ply", "empty.off").stdout)
        self.diff(0, "empty.off", "empty.off")
        self.assertIn(b"A is empty", self.diff(1, "/dev/null", "a.ply").stdout)

    def test_folders_and_update(self):
        for folder in ("a", "b", "b/deep"):
            os.mkdir(self.path(folder))
        self.mesh(BALL, "a/same.ply")
        shutil.copy(self.path("a/same.ply"), self.path("b/same.ply"))
        self.mesh(BALL, "a/part.ply")
        self.write("b/part.txt", KNOB)
        self.mesh(BALL, "a/old.stl")
        self.mesh(BALL, "b/deep/new.stl")
        self.write("a/README.txt", "not a scene")
        report = self.report(1, "a", "b", "--tol", "0.1")
        self.assertEqual({(p.get("file_a"), p["verdict"]) for p in report["pairs"]},
                         {("a/same.ply", "same"), ("a/part.ply", "different"),
                          ("a/old.stl", "only in A"), (None, "only in B")})
        text = self.diff(1, "a", "b", "--tol", "0.1").stdout.decode()
        self.assertNotIn("same.ply", text)  # what is the same is a number in the last line
        self.assertEqual(text.splitlines()[-1], "1 of 4 same")
        self.diff(1, "a", "b", "--tol", "0.1", "--update")  # old.stl stays
        self.assertEqual(self.read("a/deep/new.stl"), self.read("b/deep/new.stl"))
        os.unlink(self.path("a/old.stl"))
        self.diff(0, "a", "b", "--tol", "0.1")
        self.assert_refused(self.run_in("diff", "a", "a/same.ply"), 2, "is a folder")
        self.assert_refused(self.run_in("diff", "none/yet", "b"), 2, "none/yet is missing")
        self.assert_refused(self.run_in("diff", "a", "none", "--update"), 2, "none is missing")
        self.diff(0, "none/yet", "b", "--update")
        self.assertEqual(self.read("none/yet/deep/new.stl"), self.read("b/deep/new.stl"))
        self.diff(0, "none/yet", "b")

    def test_update_of_files(self):
        self.mesh(BALL, "b.ply")
        self.diff(0, "new.ply", "b.ply", "--update")
        self.assertEqual(self.read("new.ply"), self.read("b.ply"))
        self.mesh(KNOB, "c.ply")
        self.assertIn(b"A is now B", self.diff(0, "new.ply", "c.ply", "--update").stdout)
        self.assertEqual(self.read("new.ply"), self.read("c.ply"))

    @cli.optimised_only
    def test_update_keeps_settings(self):
        """Text stays text and what is compressed compressed, whatever the other file or a scene's default is."""
        self.write("knob.txt", KNOB)
        for name in ("a.stl", "a.ply"):
            other = "b" + name[1:]
            self.mesh(BALL, name, "--ascii")
            self.mesh(KNOB, other)
            for source in ([other], ["knob.txt", "-r", 32]):
                self.mesh(BALL, name, "--ascii")
                self.diff(0, name, *source, "--update")
                self.assertIn(self.read(name)[:32].split()[0], (b"solid", b"ply"))
                self.assertEqual(self.read(name).count(b"\0"), 0, name)
                self.diff(0, name, *source, "--tol", "1e-6")
            self.mesh(BALL, name)
            self.mesh(KNOB, other, "--ascii")
            self.diff(0, name, other, "--update")
            self.assertIn(b"\0", self.read(name))
        if cli.has_library("Draco") and cli.has_library("tinygltf"):
            self.mesh(BALL, "a.glb", "--draco")
            self.diff(0, "a.glb", "knob.txt", "-r", 32, "--update")
            self.assertIn(b"KHR_draco_mesh_compression", self.read("a.glb"))

    def test_trouble(self):
        self.mesh(BALL, "a.ply")
        self.write("broken.stl", b"\0" * 83)
        for arguments, words in (((), "two"), (("a.ply",), "two"),
                                 (("a.ply", "none.ply"), "none.ply"),
                                 (("a.ply", "broken.stl"), "broken.stl"),
                                 (("a.ply", "a.ply", "--ignore", "paint"), "paint"),
                                 (("a.ply", "a.ply", "--tol", "-1"), "--tol"),
                                 (("a.ply", "a.ply", "--normals", "none"), "--normals wants a scene"),
                                 (("a.ply", "a.ply", "-e", "1"), "-e wants a scene"),
                                 (("a.ply", "a.ply", "--heatmap", "h.stl"), "heat map")):
            result = self.run_in("diff", *arguments)
            self.assert_clean(result)
            self.assert_status(result, 2)
            self.assertIn(words, result.stderr)
        self.assert_files("a.ply", "broken.stl")

    def git(self, *arguments, status=0):
        result = subprocess.run(["git", *arguments], cwd=self.folder, check=False, timeout=60,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                env={**os.environ, "HOME": self.folder, "GIT_CONFIG_NOSYSTEM": "1"})
        self.assertEqual(result.returncode, status, result.stdout)
        return result.stdout

    def test_git(self):
        """The recipes of docs/diff.md."""
        if not shutil.which("git"):
            self.skipTest("git is not there")
        self.git("init", "-q")
        self.git("config", "user.email", "a@b")
        self.git("config", "user.name", "a")
        self.mesh(BALL, "ball.stl")
        self.git("add", "ball.stl")
        self.git("commit", "-q", "-m", "a ball")
        self.mesh(KNOB, "ball.stl")
        self.git("config", "diff.tool", "csgmesh")
        self.git("config", "difftool.csgmesh.cmd",
                 f'"{cli.PROGRAM}" diff "$LOCAL" "$REMOTE" --tol 0.01')
        out = self.git("difftool", "--no-prompt", "HEAD")
        self.assertIn(b"apart, more than 0.01", out)
        self.write(".gitattributes", "*.stl diff=csgmesh\n")
        self.git("config", "diff.csgmesh.command",
                 f"sh -c '\"{cli.PROGRAM}\" diff \"$2\" \"$5\" --tol 0.01 || test $? = 1' --")
        self.assertIn(b"apart, more than 0.01", self.git("diff", "HEAD"))


class AgainstScipy(diff_support.DiffTest):
    """Samples of another program lie below our upper bounds, and its vertices not above."""

    def test_sampled(self):
        try:
            import numpy
            from scipy.spatial import cKDTree
        except ImportError:
            self.skipTest("no scipy")
        self.mesh(BALL, "a.off", "--normals", "none")
        self.mesh("translate([0.5, 0, 0]) cube(15, center = true);", "b.off", "--normals", "none")

        def load(name):
            lines = self.read(name).decode().split("\n")
            count, faces, _ = map(int, lines[1].split())
            points = numpy.array([[float(x) for x in line.split()[:3]]
                                  for line in lines[2:2 + count]])
            corners = numpy.array([[int(x) for x in line.split()[1:4]]
                                   for line in lines[2 + count:2 + count + faces]])
            return points, corners

        def spread(points, corners, n):
            weights = numpy.random.default_rng(1).dirichlet((1, 1, 1), (len(corners), n))
            return numpy.einsum("fnk,fkd->fnd", weights, points[corners]).reshape(-1, 3)

        report = self.report(1, "a.off", "b.off")
        meshes = [load("a.off"), load("b.off")]
        for i, key in enumerate(("a_to_b", "b_to_a")):
            own, other = meshes[i], meshes[1 - i]
            dense = spread(*other, 60)
            # to a cloud on the surface: at least the distance to it; the gap of the cloud is small
            away, _ = cKDTree(dense).query(own[0])
            upper = report[key]["max_upper"]
            self.assertGreaterEqual(away.max() * (1 + 1e-9), report[key]["max_lower"] * 0.98)
            self.assertLessEqual(away.max(), upper + 0.15)
            self.assertLess(report[key]["mean"], away.max())


@unittest.skipUnless(shutil.which("git"), "no git")
class Git(cli.CliTest):
    """The lines of docs/diff.md, as they stand there."""

    def setUp(self):
        super().setUp()
        page = os.path.join(os.path.dirname(__file__), "../../docs/diff.md")
        with open(page, encoding="utf-8") as file:
            self.lines = [line.strip() for line in file if line.startswith("git config diff.csgmesh.")]
        os.mkdir(self.path("bin"))
        os.symlink(cli.PROGRAM, self.path("bin/csgmesh"))
        self.git("init -q .")
        self.write(".gitattributes", "*.stl diff=csgmesh\n")
        for height in (10, 11):
            self.write("part.txt", f"cube([10, 10, {height}]);\n")
            self.assertEqual(cli.run("part.txt", "-o", "part.stl", cwd=self.folder).returncode, 0)
            if height == 10:
                self.git("add -A")
                self.git("-c user.name=a -c user.email=a@example.org commit -qm first")

    def git(self, words):
        result = subprocess.run(words if words.startswith("git") else "git " + words, shell=True, cwd=self.folder,
                                capture_output=True, text=True, check=False,
                                env={**os.environ, "PATH": self.path("bin") + ":" + os.environ["PATH"],
                                     "HOME": self.folder, "GIT_CONFIG_NOSYSTEM": "1", "GIT_PAGER": "cat"})
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_textconv(self):
        for line in self.lines:
            if "textconv" in line:
                self.git(line)
        said = self.git("diff -- part.stl")
        changed = [line for line in said.splitlines() if line[0] in "+-" and line[:3] not in ("+++", "---")]
        self.assertTrue(any("volume" in line and "1000" in line for line in changed), said)
        self.assertTrue(any("volume" in line and "1100" in line for line in changed), said)
        self.assertNotIn("/tmp", "".join(changed))
        self.assertFalse(any("triangles" in line for line in changed), said)

    def test_command(self):
        self.git(next(line for line in self.lines if "diff.csgmesh.command" in line))
        self.assertIn("different:", self.git("diff -- part.stl"))


if __name__ == "__main__":
    if "--thorough" in sys.argv:
        sys.argv.remove("--thorough")
    else:
        AgainstScipy = None
    cli.main()
