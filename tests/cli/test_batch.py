# SPDX-License-Identifier: MIT
"""csgmesh batch: names, sets, parts, manifests, reports; what is up to date; the cache."""
import json
import os
import re
import shutil
import subprocess
import time
import unittest
import xml.etree.ElementTree as xml

import cli
from batch_support import BASE, BatchTest, MUG, SETS, needs_hashes

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SMALL = ["-r", "12"]


class Names(BatchTest):
    def setUp(self):
        super().setUp()
        self.scenes()

    def made(self, *arguments):
        self.batch(*arguments, "-d", "out", *SMALL)
        return sorted(self.outputs())

    def test_scenes(self):
        self.assertEqual(self.made("mug.txt", "ball.txt"), ["ball.glb", "mug.glb"])

    def test_patterns_are_expanded_without_a_shell(self):
        self.assertEqual(self.made("b*.txt"), ["ball.glb", "box.glb"])

    def test_formats(self):
        self.assertEqual(self.made("ball.txt", "-f", "stl,ply"), ["ball.ply", "ball.stl"])

    def test_all_sets(self):
        self.assertEqual(self.made("mug.txt", "-p", "sets.json", "-P", "*"),
                         ["mug-large.glb", "mug-small.glb"])

    def test_one_set_as_mesh_makes_it(self):
        self.assertEqual(self.made("mug.txt", "-p", "sets.json", "-P", "large"), ["mug-large.glb"])
        self.run_in("mug.txt", "-p", "sets.json", "-P", "large", "-o", "one.glb", *SMALL)
        self.assertEqual(self.read("one.glb"), self.outputs()["mug-large.glb"])

    def test_sets_beside_the_scene(self):
        self.write("mug.json", json.dumps(SETS))
        self.assertEqual(self.made("mug.txt", "ball.txt", "-P", "*"),
                         ["ball.glb", "mug-large.glb", "mug-small.glb"])

    def test_parts(self):
        name = "{scene}/{part}.{ext}"
        self.assertEqual(self.made("box.txt", "--name", name, "-f", "glb,stl"),
                         ["box/box.glb", "box/box.stl", "box/lid.glb", "box/lid.stl"])
        self.run_in("ball.txt", "-o", "ball.stl", *SMALL)
        lid = self.info("out/box/lid.stl")["mesh"]
        whole = self.stats("box.txt", "-o", "whole.stl", *SMALL)["mesh"]
        box = self.info("out/box/box.stl")["mesh"]
        self.assertEqual(lid["components"], 1)
        self.assertEqual(lid["triangles"] + box["triangles"], whole["triangles"])
        self.assertEqual(lid["boundary_edges"], 0)

    def test_a_scene_without_parts_has_a_name_too(self):
        self.assertEqual(self.made("ball.txt", "--name", "{scene}-{set}-{part}.{ext}"),
                         ["ball.glb"])

    def test_folders(self):
        os.mkdir(self.path("sub"))
        shutil.copy(self.path("ball.txt"), self.path("sub/ball.txt"))
        result = self.run_in("batch", "ball.txt", "sub/ball.txt", "-d", "out")
        self.assert_refused(result, 1, "written twice", "--name")
        self.assertEqual(self.made("ball.txt", "sub/ball.txt", "--name", "{folder}/{scene}.{ext}"),
                         ["ball.glb", "sub/ball.glb"])

    def test_hostile_names(self):
        self.write("sets.json", json.dumps({"parameterSets": {"../../x\n": {"radius": "2"}}}))
        self.assertEqual(self.made("mug.txt", "-p", "sets.json", "-P", "*"), ["mug-.._.._x_.glb"])
        for name in ("../{scene}.{ext}", "/tmp/{scene}.{ext}", "a//{scene}.{ext}"):
            result = self.run_in("batch", "mug.txt", "-d", "out", "--name", name)
            self.assert_refused(result, 1, "no name for an output")
        self.assert_refused(self.run_in("batch", "mug.txt", "-d", "out", "--name", "{nam}.{ext}"),
                            1, "{nam}", "placeholders")
        self.assert_refused(self.run_in("batch", "mug.txt", "-d", "out", "--name", "a.glb"), 1,
                            "{ext}")

    def test_usage(self):
        for arguments, words in ((["-d", "out"], ["no scenes"]), (["ball.txt"], ["-d DIR"]),
                                 (["ball.txt", "-d", "out", "-k", "--fail-fast"], ["exclude"]),
                                 (["-", "-d", "out"], ["files"])):
            self.assert_refused(self.run_in("batch", *arguments), 2, *words)
        self.assert_refused(self.run_in("batch", "ball.txt", "-d", "out", "-f", "glb,foo"), 1,
                            "unknown format 'foo'", "formats:")
        self.assert_refused(self.run_in("batch", "mug.txt", "-d", "out", "-p", "sets.json"), 1, "-P")
        self.assert_refused(
            self.run_in("batch", "mug.txt", "-d", "out", "-p", "sets.json", "-P", "huge"), 1,
            "no parameter set 'huge'", "'small', 'large'")


@unittest.skipUnless(cli.has_library("nlohmann-json"), "no JSON in this build")
class Manifests(BatchTest):
    def setUp(self):
        super().setUp()
        self.scenes()

    def manifest(self, content):
        return self.write("parts.json", json.dumps(content))

    def test_everything(self):
        self.manifest({"$schema": "x", "directory": "made", "formats": ["glb", "stl"],
                       "resolution": 12, "jobs": [
                           "ball.txt",
                           {"scene": "mug.txt", "parameter_file": "sets.json", "sets": ["s*"]},
                           {"scene": "mug.txt", "out": "plain.ply", "cell_size": 1,
                            "defines": {"radius": 3}, "ascii": True}]})
        self.batch("parts.json")
        self.assertEqual(sorted(self.outputs("made")),
                         ["ball.glb", "ball.stl", "mug-small.glb", "mug-small.stl", "plain.ply"])
        self.run_in("mug.txt", "-s", "1", "-D", "radius=3", "--ascii", "-o", "same.ply")
        self.assertEqual(self.read("same.ply"), self.outputs("made")["plain.ply"])

    def test_paths_are_beside_the_manifest(self):
        self.manifest(["mug.txt"])
        os.mkdir(self.path("elsewhere"))
        result = cli.run("batch", "../parts.json", "-d", "out", *SMALL, cwd=self.path("elsewhere"))
        self.assert_status(result, 0)
        self.assertEqual(list(self.outputs("elsewhere/out")), ["mug.glb"])

    def test_the_command_line_wins(self):
        self.manifest({"resolution": 99, "jobs": [{"scene": "ball.txt", "cell_size": 0.01}]})
        self.batch("parts.json", "-d", "out", "-r", "8", "-f", "ply")
        self.run_in("ball.txt", "-r", "8", "-o", "ball.ply")
        self.assertEqual(self.outputs(), {"ball.ply": self.read("ball.ply")})

    def test_values(self):
        self.write("v.txt", 'a = 1; b = "x"; c = true; d = [1]; e = 5;\n'
                   'echo(a, b, c, d, e);\nsphere(1);\n')
        self.manifest([{"scene": "v.txt", "resolution": 8, "defines": {
            "a": -2.5, "b": "say \"hi\" \\ $5", "c": False, "d": [1, [2, "y"]], "e": None}}])
        self.batch("parts.json", "-d", "out")
        self.assertIn('-2.5, "say "hi" \\ $5", false, [1, [2, "y"]], undef',
                      self.lines[0]["messages"].replace('\\"', '"').replace("\\\\", "\\"))

    def test_faults_have_a_place(self):
        for content, *words in (
                ([{"scene": "ball.txt", "resolutoin": 5}], "jobs[0]", 'did you mean "resolution"'),
                ([{"scene": "ball.txt", "resolution": "fine"}], "jobs[0]", "--resolution wants"),
                (["ball.txt", {"out": "a.glb"}], "jobs[1]", "names no scene"),
                ([{"scene": "ball.txt", "out": "a.xyz"}], "jobs[0]", "tells no format"),
                ([{"scene": "ball.txt", "out": "../a.glb"}], "jobs[0]", "no name for an output"),
                ([{"scene": "ball.txt", "draco": 5}], "jobs[0]", "true or false"),
                ([{"scene": "ball.txt", "defines": 5}], "jobs[0]", "object"),
                ([{"scene": "no*.txt"}], "jobs[0]", "no scene matches"),
                ([{"scene": "ball.txt", "root": ["out"]}], "jobs[0]", '"root"'),
                ([5], "jobs[0]", "no job"), ({"jobs": []}, "lists no jobs"), ({}, "lists no jobs")):
            self.manifest(content)
            result = self.run_in("batch", "parts.json", "-d", "out")
            self.assert_refused(result, 1, "parts.json", *words)
        self.write("parts.json", '{"jobs": [\n  "ball.txt",\n]}')
        self.assert_refused(self.run_in("batch", "parts.json", "-d", "out"), 1, "parts.json:3:1",
                            "not JSON")
        self.write("parts.json", "[" * 5000)
        self.assert_refused(self.run_in("batch", "parts.json", "-d", "out"), 2, "nested")
        self.assert_refused(self.run_in("batch", "none.json", "-d", "out"), 2, "none.json", "No such")

    def test_the_schema_knows_every_option(self):
        with open(os.path.join(ROOT, "tools/integrations/batch.schema.json"), encoding="utf-8") as file:
            schema = json.load(file)
        with open(os.path.join(ROOT, "tools/csgmesh/core/options.def"), encoding="utf-8") as file:
            rows = re.findall(r'OPTION\(\w+,\s*[^,]+,\s*"([^"]+)",\s*(\w+),\s*(?:"[^"]*"|NULL),\s*'
                              r"([A-Z_| ]+),", file.read())
        of_batches = {"format", "parameter-file", "parameter-set", "quiet", "progress", "color",
                      "diagnostics", "threads", "help", "version", "json", "define", "include", "trace", "root", "sandbox", "watch"}
        wanted = {name.replace("-", "_") for name, _, commands in rows
                  if ("ANY" in commands or {"MESH", "BATCH"} <= set(commands.split(" | ")))
                  and name not in of_batches}
        known = set(schema["$defs"]["options"]["properties"])
        own = {"formats", "name", "defines", "parameter_file", "sets", "include"}
        self.assertEqual(wanted - known, set(), "options that the schema does not know")
        for key in known - own: # what the schema allows, the program takes or knows not at all
            self.manifest([{"scene": "ball.txt", key: {}}])
            result = self.run_in("batch", "parts.json", "-d", "out")
            self.assert_refused(result, 1, f'"{key}"')
        self.assertEqual(known - own - wanted - {"tolerance", "simplify", "improve", "certify"},
                         set())


@needs_hashes
class UpToDate(BatchTest):
    def setUp(self):
        super().setUp()
        self.scenes()
        self.all = ["mug.txt", "box.txt", "ball.txt", "-d", "out", *SMALL]
        self.batch(*self.all)
        self.before = self.times()

    def again(self, *arguments):
        """Which scenes were made again."""
        self.batch(*self.all, *arguments)
        return {line["scene"] for line in self.lines[:-1] if line["outcome"] != "up to date"}

    def test_nothing_to_do(self):
        self.assertEqual(self.again(), set())
        self.assertEqual(self.times(), self.before)

    def test_times_do_not_count(self):
        os.utime(self.path("mug.txt"))
        self.assertEqual(self.again(), set())

    def test_an_include(self):
        self.write("lib/base.txt", "module base(r) cube(r);\n")
        self.assertEqual(self.again(), {"mug.txt"})
        self.assertEqual(self.again(), set())

    def test_the_same_bytes_are_not_written(self):
        self.write("lib/base.txt", BASE + "// a remark\n")
        self.assertEqual(self.again(), {"mug.txt"})
        self.assertEqual(self.times(), self.before)

    def test_options(self):
        self.assertEqual(len(self.again("-r", "13")), 3)
        self.assertEqual(len(self.again("-r", "12")), 3)
        self.assertEqual(self.again("--no-sync", "--timeout", "100", "-j", "1"), set())
        self.assertEqual(len(self.again("--force")), 3)
        self.assertEqual(len(self.again("-Werror")), 3)

    def test_another_program(self):
        """Whatever may be its default: what another build of csgmesh made is made again."""
        other = self.path("other")
        shutil.copy(cli.PROGRAM, other)
        with open(other, "ab") as file:
            file.write(b"!")
        run = subprocess.run([other, "batch", *self.all, "--json"], cwd=self.folder, capture_output=True, check=False)
        self.assertEqual([json.loads(line)["outcome"] for line in run.stdout.splitlines()[:-1]], ["made"] * 3)
        self.assertEqual(len(self.again()), 3)
        self.assertEqual(self.again(), set())

    def test_outputs_that_are_gone_or_not_ours(self):
        os.remove(self.path("out/mug.glb"))
        with open(self.path("out/ball.glb"), "r+b") as file:
            file.seek(100)
            file.write(b"x")
        self.assertEqual(self.again(), {"mug.txt", "ball.txt"})
        os.utime(self.path("out/box.glb"))
        self.assertEqual(self.again(), set())

    def test_a_broken_record(self):
        for name in os.listdir(self.path("out/.csgmesh-cache")):
            if name != "lock":
                content = self.read(f"out/.csgmesh-cache/{name}")
                self.write(f"out/.csgmesh-cache/{name}", content[:len(content) // 2])
        self.assertEqual(len(self.again()), 3)

    def test_one_set_of_a_file(self):
        sets = ["mug.txt", "-d", "out", *SMALL, "-p", "sets.json", "-P", "*"]
        self.batch(*sets)
        changed = json.loads(json.dumps(SETS))
        changed["parameterSets"]["large"]["radius"] = "9"
        self.write("sets.json", json.dumps(changed))
        outcomes = self.batch(*sets)
        self.assertEqual(outcomes["out/mug-small.glb"], "up to date")
        self.assertEqual(outcomes["out/mug-large.glb"], "made")

    def test_an_import(self):
        self.run_in("ball.txt", "-o", "tool.stl", "-r", "8")
        self.write("i.txt", 'import("tool.stl");\n')
        arguments = ["i.txt", "-d", "out", *SMALL]
        self.batch(*arguments)
        self.assertEqual(self.batch(*arguments)["out/i.glb"], "up to date")
        self.run_in("ball.txt", "-o", "tool.stl", "-r", "9")
        self.assertEqual(self.batch(*arguments)["out/i.glb"], "made")

    @unittest.skipUnless(cli.has_library("fontconfig"), "no fonts in this build")
    def test_fonts_are_files_too(self):
        self.write("t.txt", 'linear_extrude(1) text("a");\n')
        self.batch("t.txt", "-d", "fonts", *SMALL)
        records = [self.read(f"fonts/.csgmesh-cache/{name}")
                   for name in os.listdir(self.path("fonts/.csgmesh-cache"))]
        self.assertRegex(b"".join(records), rb"in \w{40} A/.*\.(ttf|otf)")

    def test_a_file_that_is_found_first_now(self):
        for folder in ("one", "two"):
            os.mkdir(self.path(folder))
        self.write("two/shape.txt", "module shape() sphere(1);\n")
        self.write("s.txt", "include <shape.txt>\nshape();\n")
        arguments = ["s.txt", "-d", "out", *SMALL, "-I", "one", "-I", "two"]
        self.batch(*arguments)
        self.assertEqual(self.batch(*arguments)["out/s.glb"], "up to date")
        self.write("one/shape.txt", "module shape() cube(1);\n")
        self.assertEqual(self.batch(*arguments)["out/s.glb"], "made")
        self.write("shape.txt", "module shape() cube(2);\n")
        self.assertEqual(self.batch(*arguments)["out/s.glb"], "made")
        self.assertEqual(self.batch(*arguments)["out/s.glb"], "up to date")

    def test_failures_are_tried_again(self):
        self.write("ball.txt", "sphere(r = );\n")
        for _ in range(2):
            self.batch(*self.all, status=1)
            self.assertEqual([line["outcome"] for line in self.lines[:-1]],
                             ["up to date", "up to date", "failed"])
        self.assertIn("ball.glb", self.outputs()) # the old one stays


@needs_hashes
class Cache(BatchTest):
    def checkout(self, name):
        os.mkdir(self.path(name))
        os.mkdir(self.path(name + "/lib"))
        self.write(name + "/mug.txt", MUG)
        self.write(name + "/lib/base.txt", BASE)
        return cli.run("batch", f"{self.path(name)}/mug.txt", "-d", self.path(name + "/out"),
                       "--cache", self.path("cache"), *SMALL, "-f", "glb,stl", "--json",
                       "--depfiles").stdout

    def test_another_checkout(self):
        self.assertIn(b'"made": 1', self.checkout("one"))
        self.assertIn(b'"cached": 1', self.checkout("two"))
        one, two = self.outputs("one/out"), self.outputs("two/out")
        self.assertEqual([one[n] for n in ("mug.glb", "mug.stl")],
                         [two[n] for n in ("mug.glb", "mug.stl")])
        self.assertIn(self.path("two/lib/base.txt").encode(), two["mug.glb.d"])
        self.assertNotIn(self.path("one").encode(), two["mug.glb.d"])

    def test_no_paths_in_it(self):
        self.checkout("one")
        for content in self.outputs("cache").values():
            self.assertNotIn(self.folder.encode(), content)

    def test_a_broken_object(self):
        self.checkout("one")
        for place, _, names in os.walk(self.path("cache/objects")):
            for name in names:
                self.write(os.path.join(place, name), b"broken")
        self.assertIn(b'"made": 1', self.checkout("two"))
        self.assertEqual(self.outputs("one/out")["mug.stl"], self.outputs("two/out")["mug.stl"])
        self.assertIn(b'"cached": 1', self.checkout("three")) # mended


class Reports(BatchTest):
    def setUp(self):
        super().setUp()
        self.scenes()
        self.write("bad.txt", "sphere(r = );\n")

    def test_failures(self):
        result = self.run_in("batch", "bad.txt", "ball.txt", "-d", "out", *SMALL)
        self.assert_status(result, 1)
        self.assertRegex(result.stderr, r"^failed: bad.txt\nbad.txt:1:12: error E0\d+: ")
        self.assertRegex(result.stdout.decode(), r"made +1 +1 .*\nfailed +1\nall +2 ")
        self.assertEqual(list(self.outputs()), ["ball.glb"])

    def test_worst_status(self):
        result = self.run_in("batch", "bad.txt", "missing.txt", "-d", "out")
        self.assert_status(result, 2)
        self.assertIn("No such file", result.stderr)

    def test_fail_fast(self):
        outcomes = self.batch("bad.txt", "ball.txt", "mug.txt", "-d", "out", "-j", "1",
                              "--fail-fast", status=1)
        self.assertEqual((outcomes[None]["failed"], outcomes[None]["not_run"]), (1, 2))

    def test_warnings_are_told_and_do_not_fail(self):
        self.write("w.txt", "a = 1;\na = 2;\nsphere(a);\n")
        result = self.run_in("batch", "w.txt", "-d", "out", *SMALL)
        self.assert_status(result, 0)
        self.assertRegex(result.stderr, r"^note: w.txt\nw.txt:2:1: warning ")
        result = self.run_in("batch", "w.txt", "-d", "out2", *SMALL, "-q")
        self.assertEqual((result.stderr, result.stdout), ("", b""))
        self.assert_status(self.run_in("batch", "w.txt", "-d", "out3", *SMALL, "-Werror"), 1)
        self.assertEqual(self.outputs("out3"), {})

    def test_junit(self):
        self.run_in("batch", "bad.txt", "ball.txt", "-d", "out", *SMALL, "--junit", "r.xml")
        suite = xml.fromstring(self.read("r.xml"))
        self.assertEqual((suite.get("tests"), suite.get("failures")), ("2", "1"))
        failure = suite.find("testcase/failure")
        self.assertIn("error E0", failure.get("message"))
        self.assertIn("sphere(r = );", failure.text)
        self.assertNotIn("timestamp", suite.attrib)

    def test_full_report(self):
        result = self.run_in("batch", "ball.txt", "-d", "out", *SMALL, "--junit", "/dev/full")
        self.assert_status(result, 2)
        self.assertIn("No space left", result.stderr)

    def test_progress(self):
        result = self.run_in("batch", "ball.txt", "mug.txt", "-d", "out", *SMALL,
                             "--progress=always")
        self.assertRegex(result.stderr, r"\[=*>? *\] \d/2")

    def test_depfiles(self):
        self.batch("mug.txt", "-d", "out", *SMALL, "-f", "glb,stl", "--depfiles", "-p", "sets.json",
                   "-P", "small")
        rule = self.read("out/mug-small.stl.d").decode()
        self.assertTrue(rule.startswith("out/mug-small.stl: \\\n  mug.txt \\\n  lib/base.txt"), rule)
        self.assertIn("sets.json", rule)
        os.remove(self.path("out/mug-small.glb.d"))
        self.batch("mug.txt", "-d", "out", *SMALL, "-f", "glb,stl", "--depfiles", "-p", "sets.json",
                   "-P", "small")
        self.assertIn("mug-small.glb.d", self.outputs())


class SameBytes(BatchTest):
    def test_threads(self):
        """One long job, which is put off and made by all threads, among many short ones."""
        self.scenes()
        names = self.many(20)
        short = [*names[:2], *({"scene": name, "resolution": 24} for name in names[2:])]
        self.write("parts.json", json.dumps([
            *short, {"scene": "mug.txt", "resolution": 160, "formats": ["ply", "3mf"]}]))
        for threads in (1, 5):
            self.batch("parts.json", "-d", f"out{threads}", "-j", threads)
        self.assertEqual(self.outputs("out1"), self.outputs("out5"))
        order = [line["scene"] for line in self.lines[:-1]]
        self.assertEqual(order, [*names, "mug.txt"])

    def test_time_and_place(self):
        self.scenes()
        self.batch("mug.txt", "box.txt", "-d", "out", *SMALL, "-f", "glb,3mf,obj")
        shutil.copytree(self.path("lib"), self.path("elsewhere/lib"))
        for name in ("mug.txt", "box.txt"):
            shutil.copy(self.path(name), self.path("elsewhere"))
        time.sleep(1.1)
        absolute = [self.path("elsewhere/" + name) for name in ("mug.txt", "box.txt")]
        self.batch(*absolute, "-d", self.path("other"), *SMALL, "-f", "glb,3mf,obj")
        self.assertEqual(self.outputs("out"), self.outputs("other"))


if __name__ == "__main__":
    cli.main()
