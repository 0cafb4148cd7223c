# SPDX-License-Identifier: MIT
"""Bad input and a hostile world: one clear message, the right exit status, no output file left."""
import json
import os
import shutil
import subprocess
import unittest

import cli


class BadInput(cli.CliTest):
    def refused(self, status, *arguments, words=(), left=()):
        result = self.run_in(*arguments, "-o", "out.glb")
        self.assert_refused(result, status, *words)
        self.assert_files(*left)

    def test_missing_file(self):
        self.refused(2, "nothing.txt", words=["nothing.txt", "No such file"])

    def test_empty_file(self):
        self.write("empty.txt", "")
        self.refused(1, "empty.txt", words=["empty"], left=["empty.txt"])

    def test_directory(self):
        os.mkdir(self.path("folder"))
        self.refused(2, "folder", words=["folder", "directory"], left=["folder"])

    def test_binary_file(self):
        self.write("binary.txt", bytes(range(256)) * 64)
        self.refused(1, "binary.txt", words=["binary.txt:"], left=["binary.txt"])

    def test_nul_bytes(self):
        self.write("nul.txt", b"sphere(r = 1);\0\0\0cube(1);")
        self.refused(1, "nul.txt", words=["nul.txt:1:15"], left=["nul.txt"])

    @unittest.skipUnless(cli.has_library("Draco"), "needs Draco")
    def test_draco_that_claims_too_much(self):
        """The counts of its first bytes, edgebreaker's and the sequential method's, would be taken before anything is decoded."""
        def count(number):  # 7 bits a byte, the lowest first
            return bytes([number & 127 | 128]) + count(number >> 7) if number > 127 else bytes([number])
        faces, zeros = count(80_000_000), bytes(4000)
        self.write("a.drc", b"DRACO\2\2\1\1\0\0\0" + count(40_000_000) + faces + b"\0" + faces + zeros)
        self.write("b.drc", b"DRACO\2\2\1\0\0\0" + faces + count(200) + b"\1" + zeros)
        for name in ("a.drc", "b.drc"):
            self.assert_refused(self.run_in("info", name), 1, "E0510", "more triangles or vertices than its bytes can hold")
        self.write("plane.txt", "linear_extrude(1) square(100);\n")
        self.assert_status(self.run_in("plane.txt", "-r", "300", "--features", "smooth", "--normals", "none", "--draco-level", "10",
                                       "-o", "plane.drc", "-q"), 0)
        self.assert_status(self.run_in("info", "plane.drc"), 0)
        self.assert_refused(self.run_in("info", "plane.drc", "--max-memory", "8M"), 2, "E0901")

    def test_missing_include(self):
        self.write("a.txt", "include <missing.txt>\nsphere(1);\n")
        self.refused(2, "a.txt", words=["a.txt:1:9: error", "missing.txt"], left=["a.txt"])

    def test_bad_define(self):
        self.write("a.txt", cli.BALL)
        self.refused(1, "a.txt", "-D", "r=(", left=["a.txt"])

    def test_unreadable_file(self):
        if os.geteuid() == 0:
            self.skipTest("root may read everything")
        self.write("a.txt", cli.BALL)
        os.chmod(self.path("a.txt"), 0)
        self.refused(2, "a.txt", words=["Permission denied"], left=["a.txt"])

    def test_unbounded_solid(self):
        self.write("a.txt", "plane([0, 0, 1], 0);\n")
        self.refused(1, "a.txt", words=["infinity", "--bounds"], left=["a.txt"])

    def test_warnings_as_errors(self):
        self.write("a.txt", "a = 1;\na = 2;\nsphere(a);\n")
        self.assert_status(self.run_in("check", "a.txt"), 0)
        self.refused(1, "a.txt", "-Werror", "-r", "8", words=["a.txt:2:1: error E"], left=["a.txt"])

    def test_worst_status_of_several(self):
        self.write("good.txt", cli.BALL)
        self.write("bad.txt", "sphere(r = );\n")
        self.assert_status(self.run_in("check", "good.txt", "good.txt"), 0)
        self.assert_status(self.run_in("check", "bad.txt", "good.txt"), 1)
        self.assert_status(self.run_in("check", "missing.txt", "bad.txt"), 2)

    def test_broken_mesh(self):
        self.write("broken.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 9\n")
        result = self.run_in("info", "broken.ply")
        self.assert_refused(result, 1, "broken.ply")
        self.assert_refused(self.run_in("info", "missing.ply"), 2, "missing.ply")

    def test_json_diagnostics(self):
        self.write("bad.txt", "sphere(r = );\nnosuch();\n")
        result = self.run_in("check", "--diagnostics=json", "bad.txt")
        self.assert_status(result, 1)
        found = [cli.json.loads(line) for line in result.stderr.splitlines()]
        self.assertEqual(found[0]["severity"], "error")
        self.assertEqual((found[0]["file"], found[0]["line"]), ("bad.txt", 1))
        self.assertRegex(found[0]["code"], "^E[0-9]{4}$")


class BadOutput(cli.CliTest):
    def setUp(self):
        super().setUp()
        self.write("a.txt", cli.BALL)

    def refused(self, output, *words, arguments=()):
        result = self.run_in("a.txt", "-r", "16", "-o", output, *arguments)
        self.assert_refused(result, 2, *words)

    def test_missing_folder(self):
        self.refused("nowhere/a.glb", "nowhere/a.glb", "No such file or directory")
        self.assert_files("a.txt")

    def test_directory(self):
        os.mkdir(self.path("a.glb"))
        self.refused("a.glb", "a.glb", "Is a directory")
        self.assert_files("a.txt", "a.glb")

    def test_full_disk(self):
        for name in cli.formats_written():
            self.refused("/dev/full", "/dev/full", "No space left", arguments=["-f", name])
        self.assert_files("a.txt")

    def test_full_disk_behind_stdout(self):
        with open("/dev/full", "wb") as full:
            for arguments in (["a.txt", "-r", "16", "-f", "stl", "-o", "-"],
                              ["a.txt", "-r", "16", "--stats"],
                              ["info", "-r", "16", "a.txt"], ["deps", "a.txt"], ["--help"],
                              ["eval", "a.txt", "--at", "0,0,0"], ["dump", "--tape", "a.txt"]):
                result = self.run_in(*arguments, stdout=full)
                self.assert_refused(result, 2, "standard output", "No space left")

    def test_full_statistics(self):
        result = self.run_in("a.txt", "-r", "16", "--stats=/dev/full")
        self.assert_refused(result, 2, "/dev/full", "No space left")

    def test_statistics_in_little_memory(self):
        """With less memory than the statistics take, the mesh is there and they say less; with less than the mesh takes,
        there is neither."""
        seen = set()
        for limit in range(300, 9000, 150):
            result = self.run_in("a.txt", "-r", "48", "-j", "1", "-o", "a.obj", "--stats-full", "--stats=s.json", "--max-memory",
                                 f"{limit}K")
            self.assert_clean(result)
            self.assertIn(result.returncode, (0, 2), result.stderr)
            self.assertEqual("E0901" in result.stderr, result.returncode == 2)
            warned = "area, volume, topology" in result.stderr
            measured = None
            if result.returncode == 0:
                stats = json.loads(self.read("s.json"))
                measured = ("volume" in stats["mesh"], "volume" in stats["files"][0])
                self.assertEqual(warned, measured != (True, True))
                os.unlink(self.path("a.obj"))
            self.assertEqual(os.path.exists(self.path("a.obj")), False)
            seen.add((result.returncode, measured))
        self.assertLessEqual({(2, None), (0, (True, False)), (0, (True, True))}, seen)

    def test_closed_pipe(self):
        read, write = os.pipe()
        os.close(read)
        try:
            result = self.run_in("a.txt", "-r", "64", "-f", "ply", "-o", "-", stdout=write)
        finally:
            os.close(write)
        self.assert_refused(result, 2, "standard output", "Broken pipe")

    def test_file_size_limit(self):
        command = f"ulimit -f 1; exec '{cli.PROGRAM}' a.txt -r 64 -o out.stl"
        result = subprocess.run(["sh", "-c", command], cwd=self.folder, capture_output=True,
                                check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn(b"File too large", result.stderr)
        self.assert_files("a.txt")

    def test_read_only_folder(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        os.mkdir(self.path("locked"), 0o555)
        self.refused("locked/a.glb", "Permission denied")

    def test_old_file_survives_a_failure(self):
        self.write("out.stl", b"old")
        command = f"ulimit -f 1; exec '{cli.PROGRAM}' a.txt -r 64 -o out.stl"
        subprocess.run(["sh", "-c", command], cwd=self.folder, capture_output=True, check=False)
        self.assertEqual(self.read("out.stl"), b"old")
        self.assert_files("a.txt", "out.stl")

    def test_one_of_two_outputs_fails(self):
        result = self.run_in("a.txt", "-r", "16", "-f", "stl", "-o", "/dev/full", "-o", "b.ply")
        self.assert_status(result, 2)
        self.assert_files("a.txt", "b.ply")

    def test_warnings_of_writing(self):
        """-Werror hears them, too: no output is there then, nor has an old one changed."""
        if not cli.has_library("Draco"):
            self.skipTest("this build cannot write Draco")
        coarse = ["a.txt", "-r", "40", "-o", "a.ply", "-o", "a.drc", "-o", "b.glb", "--draco-bits", "6,8,8"]
        self.write("b.glb", "old")
        self.assert_refused(self.run_in(*coarse, "-Werror"), 1, "error E0513")
        self.assert_files("a.txt", "b.glb")
        self.assertEqual(self.read("b.glb"), b"old")
        piped = self.run_in("a.txt", *coarse[1:3], "-f", "drc", "-o", "-", *coarse[-2:], "-Werror")
        self.assertEqual((piped.returncode, len(piped.stdout)), (1, 0))
        self.write("batch.json", json.dumps({"jobs": [{"scene": "a.txt", "out": ["a.ply", "a.drc"]}]}))
        self.assert_status(self.run_in("batch", "batch.json", "-d", "out", *coarse[1:3], *coarse[-2:], "-Werror"), 1)
        self.assertEqual([name for name in os.listdir(self.path("out")) if name[0] != "."], [])
        self.assertIn("warning W0513", self.run_in(*coarse).stderr)
        self.assert_files("a.txt", "a.ply", "a.drc", "b.glb", "batch.json", "out")


class Limits(cli.CliTest):
    def limited(self, text, *arguments, words=()):
        self.write("a.txt", text)
        result = self.run_in("a.txt", "-o", "out.ply", *arguments)
        self.assert_refused(result, 2, *words)
        self.assert_files("a.txt")

    def test_timeout_of_evaluation(self):
        self.limited(cli.ENDLESS, "--timeout", "0.3", words=["0.3 seconds"])

    def test_timeout_of_meshing(self):
        self.limited(cli.BLEND, "-r", "4000", "--no-prune", "--timeout", "0.3", words=["time"])

    def test_memory(self):
        self.limited(cli.BALL, "-r", "1000", "--max-memory", "4M", words=["memory", "4 MiB"])

    def test_memory_of_evaluation(self):
        self.limited("a = [for (i = [0 : 9999]) [for (j = [0 : 9999]) j]];\nsphere(len(a));\n", "--max-memory", "20M")

    def test_depth(self):
        self.limited("x = " + "(" * 3000 + "1" + ")" * 3000 + ";\nsphere(x);\n", "--max-depth",
                     "1000")

    def test_nodes(self):
        self.limited("for (i = [1 : 5000]) translate([i, 0, 0]) sphere(0.3);\n", "--max-nodes", "1000")

    def test_steps(self):
        long = "function f(n) = n <= 0 ? 1 : f(n - 1);\nsphere(f(1e5));\n"
        self.limited(long, "--max-steps", "1e4", words=["--max-steps", "10000 steps"])
        result = self.run_in("a.txt", "-r", "8", "-o", "o.stl", "--max-steps", "1e7")
        self.assert_status(result, 0)


class Sources(cli.CliTest):
    """No output overwrites what the run reads, whatever it is called there."""

    def setUp(self):
        super().setUp()
        self.write("s.txt", "include <sizes.txt>\nimport(\"part.stl\"); sphere(r);\n")
        self.write("sizes.txt", "r = 2;\n")
        self.write("ball.txt", "sphere(1);\n")
        self.assert_status(self.run_in("ball.txt", "-r", "8", "-o", "part.stl"), 0)
        self.assert_status(self.run_in("ball.txt", "-r", "9", "-o", "other.stl"), 0)
        os.symlink("s.txt", self.path("link.txt"))
        os.link(self.path("part.stl"), self.path("hard.stl"))
        self.before = self.contents()

    def contents(self):
        found = {}
        for name in os.listdir(self.folder):
            with open(self.path(name), "rb") as file:
                found[name] = file.read()
        return found

    def test_sources_stay(self):
        for arguments in (
                ["s.txt", "-f", "stl", "-o", "s.txt"], ["s.txt", "-f", "stl", "-o", "./s.txt"],
                ["s.txt", "-f", "stl", "-o", "link.txt"], ["s.txt", "-f", "stl", "-o", "sizes.txt"],
                ["s.txt", "-o", "part.stl"], ["s.txt", "-o", "hard.stl"],
                ["s.txt", "-o", "out.stl", "--stats=s.txt"], ["s.txt", "-o", "out.stl", "-M", "sizes.txt"],
                ["s.txt", "-o", "out.stl", "-M", "./out.stl"], ["s.txt", "-o", "out.stl", "-o", "./out.stl"],
                ["s.txt", "-o", "out.stl", "--trace", "s.txt"], ["s.txt", "-o", "out.stl", "--trace", "sizes.txt"],
                ["s.txt", "-o", "out.stl", "--trace", "./part.stl"],
                ["diff", "part.stl", "other.stl", "--json", "-", "--junit", "-"],
                ["render", "s.txt", "-o", "out.png", "--stats=part.stl"],
                ["diff", "part.stl", "other.stl", "--json", "part.stl"],
                ["diff", "part.stl", "other.stl", "--html", "./other.stl"],
                ["diff", "part.stl", "s.txt", "--junit", "sizes.txt"],
                ["diff", "part.stl", "other.stl", "--json", "out", "--junit", "./out"]):
            result = self.run_in(*arguments)
            self.assert_status(result, 2)
            self.assertEqual(result.stderr.count("error"), 1, result.stderr)
            self.assertRegex(result.stderr, "would overwrite|both write to")
            self.assertEqual(self.contents(), self.before, arguments)

    def test_a_batch_leaves_imports_alone(self):
        self.write("mesh.txt", "import(\"mesh.stl\");\n")
        os.link(self.path("part.stl"), self.path("mesh.stl"))
        result = self.run_in("batch", "mesh.txt", "-d", ".", "-f", "stl", "--name", "{scene}.{ext}")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("would overwrite", result.stderr)
        with open(self.path("mesh.stl"), "rb") as file:
            self.assertEqual(file.read(), self.before["part.stl"])
        result = self.run_in("batch", "mesh.txt", "-d", "out", "-f", "stl")
        self.assert_status(result, 0)

    def test_reports_of_a_batch(self):
        """Neither --trace nor --junit overwrites what a job reads or writes, made now or up to date."""
        self.write("batch.json", json.dumps({"jobs": ["s.txt", "ball.txt"]}))
        batch = ["batch", "batch.json", "-d", "out", "-r", "8", "-f", "stl"]
        for is_made in (False, True):
            for option in ("--trace", "--junit"):
                for name in ("s.txt", "batch.json", "sizes.txt", "hard.stl", "link.txt", "out/./s.stl"):
                    if name.startswith("out") and not is_made:
                        continue
                    before = self.read(name)
                    result = self.run_in(*batch, option, name)
                    self.assert_status(result, 2)
                    self.assertRegex(result.stderr, "would overwrite|both write to")
                    self.assertEqual(self.read(name), before, f"{option} {name}")
            self.assert_status(self.run_in(*batch), 0)
        os.remove(self.path("out/ball.stl"))
        result = self.run_in(*batch, "--junit", "out/../out/ball.stl")
        self.assert_status(result, 2)
        self.assertFalse(os.path.exists(self.path("out/ball.stl")))
        shutil.rmtree(self.path("out"))
        self.assert_status(self.run_in(*batch, "--junit", "./out/ball.stl"), 2)
        self.assertFalse(os.path.exists(self.path("out/ball.stl")))
        self.assert_status(self.run_in(*batch, "--junit", "out/r.xml", "--trace", "out/t.json"), 0)

    def test_what_is_no_source_is_written(self):
        self.assert_status(self.run_in("ball.txt", "-r", "8", "-o", "other.stl", "--stats=/dev/null"), 0)
        self.assert_status(self.run_in("diff", "part.stl", "other.stl", "--update", "--json", "out.json"), 0)


if __name__ == "__main__":
    cli.main()
