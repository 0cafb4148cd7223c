# SPDX-License-Identifier: MIT
"""--trace: JSON that viewers open, zones that nest, a zone for every stage, the same mesh; and tools/trace/serial.py.

Nothing here depends on how long anything took.
"""
import json
import os
import subprocess
import sys

import cli

SERIAL = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "trace", "serial.py")
MUG = os.path.join(cli.SCENES, "parts", "mug.txt")
SOLID = """difference() {
  cube(2, center = true);
  cylinder(h = 3, r = 0.5, center = true);
}
"""


class Trace(cli.CliTest):
    def traced(self, *arguments, status=0, **options):
        """The events of a run, which must be the only thing in its trace."""
        result = self.run_in(*arguments, "--trace", "trace.json", **options)
        self.assert_clean(result)
        self.assert_status(result, status)
        return self.checked(json.loads(self.read("trace.json")))

    def checked(self, trace):
        self.assertEqual(trace["otherData"]["dropped_zones"], 0)
        zones = [event for event in trace["traceEvents"] if event["ph"] == "X"]
        names = {event["tid"] for event in trace["traceEvents"] if event["name"] == "thread_name"}
        self.assertEqual(names, {zone["tid"] for zone in zones})
        for zone in zones:
            self.assertGreaterEqual(zone["dur"], 0)
            self.assertIn(zone["cat"], ("stage", "loop"))
        for thread in names:
            self.check_nesting([zone for zone in zones if zone["tid"] == thread])
        return zones

    def check_nesting(self, zones):
        """Of one thread: each is inside of another or beside it. Times have three digits behind the point."""
        rounding = 0.002
        stack = []
        for zone in sorted(zones, key=lambda z: (z["ts"], -z["dur"])):
            end = zone["ts"] + zone["dur"]
            while stack and stack[-1] <= zone["ts"] + rounding:
                stack.pop()
            if stack:
                self.assertLessEqual(end, stack[-1] + rounding, zone)
            stack.append(end)

    def assert_stages(self, zones, *names):
        stages = {zone["name"] for zone in zones if zone["cat"] == "stage"}
        self.assertEqual(set(names) - stages, set())

    def test_stages_of_a_mesh(self):
        zones = self.traced(MUG, "-r", "48", "-j", "3", "-o", "mug.ply")
        self.assert_stages(zones, "mesh", "scene", "read text", "parse", "evaluate", "seal", "compile", "octree",
                           "build", "octree level 1", "slab", "sampling", "features: find", "features: join", "features: move",
                           "features: settle", "numbering", "marching", "sync")
        top = [zone for zone in zones if zone["tid"] == 0 and zone["cat"] == "stage" and "of" in zone.get("args", {})]
        self.assertEqual([zone["args"]["of"] for zone in top], [MUG])
        begin, end = top[0]["ts"], top[0]["ts"] + top[0]["dur"]
        for zone in zones:
            self.assertTrue(begin <= zone["ts"] and zone["ts"] + zone["dur"] <= end + 0.002, zone)
        sampling = next(zone for zone in zones if zone["name"] == "sampling" and zone["cat"] == "stage")
        self.assertGreater(sampling["args"]["blocks"], 0)
        self.assertGreater(sampling["args"]["cells"], 0)
        loops = [zone for zone in zones if zone["cat"] == "loop" and zone["name"] == "sampling"]
        self.assertGreater(sum(zone["args"]["items"] for zone in loops), 0)

    def test_threads(self):
        """With one thread there is one lane, and all loops are on it."""
        zones = self.traced(MUG, "-r", "32", "-j", "1", "-o", "mug.ply")
        self.assertEqual({zone["tid"] for zone in zones}, {0})
        self.assertTrue(any(zone["cat"] == "loop" for zone in zones))

    def test_same_bytes(self):
        for name in ("a.ply", "a.stl", "a.glb", "a.obj"):
            for threads in ("1", "4"):
                self.assert_status(self.run_in(MUG, "-r", "24", "-j", threads, "-o", name), 0)
                plain = self.read(name)
                self.traced(MUG, "-r", "24", "-j", threads, "-o", name)
                self.assertEqual(self.read(name), plain)

    def test_stages_of_thinning_and_proof(self):
        self.write("a.txt", SOLID)
        zones = self.traced("a.txt", "-r", "24", "--simplify", "0.01", "--certify", "-o", "a.obj")
        self.assert_stages(zones, "reshape", "missed parts", "decimation", "distance proof", "certify", "write", "sync")

    def test_hulls_run_the_pipeline_within_the_evaluation(self):
        self.write("a.txt", "minkowski() { cube(1); sphere(0.2); }\nhull() { sphere(1); translate([3, 0, 0]) cube(1); }\n")
        self.assert_stages(self.traced("a.txt", "-r", "16", "-o", "a.ply"), "evaluate", "marching")

    def test_pictures(self):
        self.write("a.txt", SOLID)
        small = ("--size", "64x48")
        zones = self.traced("render", "a.txt", "-o", "a.ppm", *small)
        self.assert_stages(zones, "render", "scene", "compile", "render scene", "cells of rays", "trace rays", "write picture")
        self.assert_stages(self.traced("render", "a.txt", "-o", "a.ppm", "--slice", "z=0", *small), "section")
        self.assert_stages(self.traced("render", "a.txt", "-o", "a.ppm", "--evaluator", "lazy", *small), "trace rays")
        self.assert_status(self.run_in("a.txt", "-r", "16", "-o", "a.ply"), 0)
        zones = self.traced("render", "a.ply", "-o", "a.ppm", *small)
        self.assert_stages(zones, "read mesh", "render mesh", "project", "sort triangles", "draw", "write picture")

    def test_comparison(self):
        self.write("a.txt", SOLID)
        self.write("b.txt", SOLID.replace("r = 0.5", "r = 0.6"))
        zones = self.traced("diff", "a.txt", "b.txt", "-r", "12", "--tol", "0.05", "--samples", "1000", "--field", status=1)
        self.assert_stages(zones, "diff", "weld", "match", "trees", "distances", "from A to B", "from B to A", "volume",
                           "attributes", "field")

    def test_batch(self):
        """Jobs have a zone each; threads hand their lanes on, so there are no more than there are threads."""
        names = [f"s{i}.txt" for i in range(9)]
        for i, name in enumerate(names):
            self.write(name, f"sphere({i + 1});\n")
        zones = self.traced("batch", *names, "-d", "out", "-r", "16", "-j", "2")
        jobs = [zone["args"]["of"] for zone in zones if zone["name"] == "job"]
        self.assertEqual(sorted(jobs), names)
        self.assertLessEqual(len({zone["tid"] for zone in zones}), 3)
        again = self.traced("batch", *names, "-d", "out", "-r", "16", "-j", "2")
        self.assertFalse([zone for zone in again if zone["name"] == "job"], "a trace makes nothing out of date")

    def test_standard_output(self):
        result = self.run_in(MUG, "-r", "16", "-o", "a.ply", "--trace", "-")
        self.assert_status(result, 0)
        self.checked(json.loads(result.stdout))

    def test_a_run_that_fails_is_traced(self):
        self.write("bad.txt", "sphere(r = );\n")
        zones = self.traced("bad.txt", "-o", "a.ply", status=1)
        self.assert_stages(zones, "mesh", "parse")
        self.write("slow.txt", cli.ENDLESS)
        zones = self.traced("slow.txt", "--timeout", "0.2", "-o", "a.ply", status=2)
        self.assert_stages(zones, "mesh", "evaluate")

    def test_names_that_are_no_utf8(self):
        name = b"a\xff\"\\.txt"
        try:
            with open(os.path.join(self.folder.encode(), name), "wb") as file:
                file.write(cli.BALL.encode())
        except OSError:
            self.skipTest("the file system wants UTF-8")
        result = subprocess.run([cli.PROGRAM.encode(), name, b"-r", b"16", b"-o", b"a.ply", b"--trace", b"t.json"],
                                cwd=self.folder, capture_output=True, check=False)
        self.assertEqual(result.returncode, 0)
        zones = self.checked(json.loads(self.read("t.json")))
        self.assertIn("a?\"\\.txt", [zone.get("args", {}).get("of") for zone in zones])


class Trouble(cli.CliTest):
    def test_no_such_folder(self):
        """Refused before anything is done."""
        self.write("a.txt", cli.BALL)
        result = self.run_in("a.txt", "-r", "16", "-o", "a.ply", "--trace", "nowhere/t.json")
        self.assert_refused(result, 2, "nowhere/t.json", "No such file or directory")
        self.assert_files("a.txt")

    def test_full_disk(self):
        """The mesh is there, the trace is not."""
        self.write("a.txt", cli.BALL)
        result = self.run_in("a.txt", "-r", "16", "-o", "a.ply", "--trace", "/dev/full")
        self.assert_refused(result, 2, "/dev/full", "No space left")
        self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assert_files("a.txt", "a.ply")
        self.assert_status(self.run_in("info", "a.ply"), 0)

    def test_two_results_in_one_file(self):
        self.write("a.txt", cli.BALL)
        for arguments in (["a.txt", "-o", "x.ply", "--trace", "x.ply"], ["a.txt", "-o", "x.ply", "--stats", "--trace", "-"],
                          ["a.txt", "-o", "x.ply", "-M", "x.d", "--trace", "x.d"],
                          ["diff", "a.txt", "a.txt", "--json", "-", "--trace", "-"]):
            self.assert_refused(self.run_in(*arguments), 2, "--trace", "both write to")
        self.assert_files("a.txt")

    def test_no_result_is_lost_to_a_wrong_command(self):
        self.write("a.txt", cli.BALL)
        self.write("x.ply", "what was there")
        self.assertNotEqual(self.run_in("a.txt", "-o", "x.ply", "--trace", "x.ply", "-r", "5", "-s", "1").returncode, 0)
        self.assertNotEqual(self.run_in("a.txt", "--trace", "a.txt").returncode, 0)
        self.assertEqual(self.read("x.ply"), b"what was there")
        self.assertEqual(self.read("a.txt"), cli.BALL.encode())

    def test_commands_without(self):
        self.write("a.txt", cli.BALL)
        self.assert_refused(self.run_in("check", "a.txt", "--trace", "t.json"), 2, "--trace")


def event(thread, name, begin, end, cpu, **more):
    return {"ph": "X", "pid": 1, "tid": thread, "cat": "stage", "name": name, "ts": begin * 1e6,
            "dur": (end - begin) * 1e6, "tts": 0, "tdur": cpu * 1e6, **more}


def loop(thread, name, begin, end, cpu, caller=0):
    return event(thread, name, begin, end, cpu, cat="loop") | {"args": {"items": 1, "caller": caller}}


class Serial(cli.CliTest):
    def table(self, events):
        self.write("t.json", json.dumps({"otherData": {"dropped_zones": 0}, "traceEvents": events}))
        result = subprocess.run([sys.executable, SERIAL, self.path("t.json"), "--json"], capture_output=True, check=True)
        return {row["stage"]: row for row in json.loads(result.stdout)}

    def test_shares(self):
        """Ten seconds: four of one thread alone, four of two, one of the second alone, one of nobody."""
        table = self.table([event(0, "mesh", 0, 10, 7), event(0, "octree", 3, 10, 4), loop(0, "octree", 4, 8, 4),
                            loop(1, "octree", 4, 9, 5)])
        mesh, octree = table["mesh"], table["mesh/octree"]
        self.assertAlmostEqual(mesh["wall_s"], 10)
        self.assertAlmostEqual(mesh["cpu_s"], 12)
        self.assertAlmostEqual(mesh["alone"], 0.6)
        self.assertAlmostEqual(mesh["outside_loops"], 0.5)
        self.assertAlmostEqual(octree["wall_s"], 7)
        self.assertAlmostEqual(octree["cpu_s"], 9)
        self.assertAlmostEqual(octree["alone"], 3 / 7)

    def test_runs_add_up(self):
        table = self.table([event(0, "mesh", 0, 10, 10), event(0, "slab", 1, 2, 1), event(0, "slab", 4, 7, 3)])
        self.assertEqual(table["mesh/slab"]["runs"], 2)
        self.assertAlmostEqual(table["mesh/slab"]["wall_s"], 4)
        self.assertAlmostEqual(table["mesh/slab"]["alone"], 1)

    def test_jobs_are_a_loop_of_the_batch(self):
        table = self.table([event(0, "batch", 0, 10, 0), event(2, "job", 1, 6, 5), event(3, "job", 2, 9, 7),
                            event(2, "octree", 2, 3, 1), loop(2, "octree", 2, 3, 1, caller=2)])
        self.assertAlmostEqual(table["batch"]["alone"], 0.6)
        self.assertAlmostEqual(table["batch"]["cpu_s"], 12)
        self.assertAlmostEqual(table["job/octree"]["outside_loops"], 0)

    def test_a_thread_of_the_language(self):
        """What is done on another thread in a stage's place counts in the stages around it."""
        table = self.table([event(0, "mesh", 0, 4, 0.5), event(0, "scene", 1, 3, 2)])
        self.assertAlmostEqual(table["mesh"]["cpu_s"], 2)

    def test_a_real_trace_and_none(self):
        self.assert_status(self.run_in(MUG, "-r", "24", "-o", "a.ply", "--trace", "t.json"), 0)
        text = subprocess.run([sys.executable, SERIAL, self.path("t.json")], capture_output=True, check=True, text=True)
        for name in ("stage", "mesh", "octree", "sampling", "marching", "sync"):
            self.assertIn(name, text.stdout)
        self.write("broken.json", "{")
        for name in ("broken.json", "missing.json"):
            result = subprocess.run([sys.executable, SERIAL, self.path(name)], capture_output=True, check=False, text=True)
            self.assertEqual(result.returncode, 2)
            self.assertIn(name, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1)


if __name__ == "__main__":
    cli.main()
