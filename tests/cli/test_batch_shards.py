# SPDX-License-Identifier: MIT
"""csgmesh batch on many machines: --shard, and reports that are one again by --merge-reports. Every scene is made by one
shard exactly, whatever the number of shards; shares are even; what comes or goes moves few others.
"""
import glob
import json
import os
import random
import shlex
import subprocess
import time
import unittest
import xml.etree.ElementTree as xml

import cli
from batch_support import BatchTest, digest, needs_hashes
from test_ranks import launcher

SMALL = ["-r", "6"]


class ShardTest(BatchTest):
    COUNT = 120

    def setUp(self):
        super().setUp()
        self.names = self.many(self.COUNT)

    def share(self, shard, *arguments, scenes=None):
        """The names of what a shard makes, from the rules that it would have."""
        result = self.run_in("batch", *(scenes or self.names), "-d", "out", "--emit", "ninja", "--shard", shard, *arguments)
        self.assert_status(result, 0)
        return [line.split()[1].rstrip(":") for line in result.stdout.decode().splitlines() if line.startswith("build out/")]

    def shares(self, count, *arguments, scenes=None):
        return [self.share(f"{i + 1}/{count}", *arguments, scenes=scenes) for i in range(count)]

    def where(self, count, *arguments, scenes=None):
        return {name: i for i, names in enumerate(self.shares(count, *arguments, scenes=scenes)) for name in names}


class Shares(ShardTest):
    def test_every_scene_once(self):
        for count in (1, 2, 7, 20):
            shares = self.shares(count)
            made = sorted(name for names in shares for name in names)
            self.assertEqual(made, sorted(f"out/a{n}.glb" for n in range(self.COUNT)), count)
            most = max(len(names) for names in shares)
            average = self.COUNT / count
            self.assertLessEqual(most, max(average * 17 / 16, average + 1), f"{count} shards")

    def test_more_shards_than_scenes(self):
        few = self.names[:3]
        shares = self.shares(5, scenes=few)
        self.assertEqual(sorted(len(names) for names in shares), [0, 0, 1, 1, 1])
        empty = [len(names) for names in shares].index(0) + 1
        outcomes = self.batch(*few, "-d", "out", "--shard", f"{empty}/5")
        self.assertEqual((outcomes[None]["jobs"], outcomes[None]["all_jobs"]), (0, 3))

    def test_the_order_does_not_matter(self):
        mixed = list(self.names)
        random.Random(5).shuffle(mixed)
        self.assertEqual(self.where(7), self.where(7, scenes=mixed))

    def test_one_scene_more_moves_few(self):
        """Of 119 scenes in 8 shards by their place in the list, about 100 would move."""
        whole = self.where(8)
        for left_out in (17, 60):
            fewer = self.where(8, scenes=self.names[:left_out] + self.names[left_out + 1:])
            moved = sum(whole[name] != shard for name, shard in fewer.items())
            self.assertLess(moved, 12, f"without {left_out}")

    def test_a_scene_that_changes_stays(self):
        before = self.where(8)
        for name in self.names[:10]:
            self.write(os.path.relpath(name, self.folder) if os.path.isabs(name) else name, "cube(5);\n")
        self.assertEqual(self.where(8), before)


@cli.unittest.skipUnless(cli.has_library("nlohmann-json"), "no JSON in this build")
class Times(ShardTest):
    def report(self, times):
        """What an earlier run has said, with other times."""
        self.batch(*self.names, "-d", "out", *SMALL)
        jobs = self.lines[:-1]
        for job, seconds in zip(jobs, times):
            job["cpu_seconds"] = seconds
        self.write("times.json", "".join(json.dumps(line) + "\n" for line in self.lines))
        return {job["outputs"][0]["file"]: job["cpu_seconds"] for job in jobs}

    def test_shares_of_the_same_time(self):
        generator = random.Random(3)
        cost = self.report([generator.paretovariate(1.3) for _ in self.names])
        for count in (2, 5, 8):
            loads = [sum(cost[name] for name in names) for names in self.shares(count, "--times", "times.json")]
            self.assertLessEqual(max(loads), max(sum(loads) / count * 17 / 16, max(cost.values())) + 1e-3, count)
        by_number = [sum(cost[name] for name in names) for names in self.shares(8)]
        self.assertGreater(max(by_number), sum(by_number) / 8 * 1.3, "the times are even, and show nothing")

    def test_scenes_without_times(self):
        self.report([1 + n % 3 for n in range(self.COUNT)])
        kept = self.read("times.json").decode().splitlines()
        self.write("times.json", "\n".join(kept[::2]) + "\n")
        made = [name for names in self.shares(6, "--times", "times.json") for name in names]
        self.assertEqual(len(set(made)), self.COUNT)
        self.assertEqual(len(made), self.COUNT)

    @needs_hashes
    def test_what_is_up_to_date_keeps_its_time(self):
        """So the latest report has the times of all, not only of what it has made."""
        self.batch(*self.names[:4], "-d", "out", "--cache", "cache", *SMALL)
        made = [job["cpu_seconds"] for job in self.lines[:-1]]
        for folder, outcome in (("out", "up to date"), ("other", "cached")):
            self.batch(*self.names[:4], "-d", folder, "--cache", "cache", *SMALL)
            self.assertEqual({job["outcome"] for job in self.lines[:-1]}, {outcome})
            for job, seconds in zip(self.lines[:-1], made):
                self.assertGreater(job["cpu_seconds"], 0)
                self.assertLessEqual(abs(job["cpu_seconds"] - seconds), 1.001e-6) # it is noted in microseconds

    def test_no_report(self):
        self.write("times.json", "made 5\n")
        for arguments, status, words in ((["--times", "times.json"], 1, "times.json:1: this is no report"),
                                         (["--times", "none.json"], 2, "none.json")):
            self.assert_refused(self.run_in("batch", *self.names, "-d", "out", "--shard", "1/2", *arguments), status, words)
        self.assert_refused(self.run_in("batch", *self.names, "-d", "out", "--times", "times.json"), 2, "--shard")


class WhichOne(ShardTest):
    COUNT = 6

    def test_bad_numbers(self):
        for text, words in (("0/8", "no shard 0 of 8"), ("9/8", "no shard 9 of 8"), ("3", "wants I/N"), ("a/b", "wants I/N"),
                            ("1/0", "N is from 1"), ("-1/4", "wants I/N"), ("1/2/3", "wants I/N"), ("", "wants I/N"),
                            ("1/99999999999", "wants I/N"), ("1/200000", "N is from 1 to 100000"), (" 1/2", "wants I/N")):
            result = self.run_in("batch", *self.names, "-d", "out", "--shard", text)
            self.assert_refused(result, 2, words)
            self.assertEqual(result.stderr.count("error"), 1)
        self.assertFalse(os.path.exists(self.path("out")))

    def slurm(self, **variables):
        environment = {**os.environ, **{"SLURM_" + name: value for name, value in variables.items()}}
        return self.run_in("batch", *self.names, "-d", "out", *SMALL, "--shard", "slurm", env=environment)

    def test_slurm(self):
        for variables, shard in (
                ({"ARRAY_TASK_ID": "7", "ARRAY_TASK_MIN": "5", "ARRAY_TASK_COUNT": "4"}, "3 of 4"),
                ({"ARRAY_TASK_ID": "9", "ARRAY_TASK_MIN": "1", "ARRAY_TASK_STEP": "4", "ARRAY_TASK_COUNT": "3"}, "3 of 3"),
                ({"PROCID": "0", "STEP_NUM_TASKS": "8"}, "1 of 8"),
                ({"ARRAY_TASK_ID": "1", "ARRAY_TASK_MIN": "0", "ARRAY_TASK_COUNT": "2", "PROCID": "2", "STEP_NUM_TASKS": "3"},
                 "6 of 6")):
            result = self.slurm(**variables)
            self.assert_status(result, 0)
            self.assertIn(f"shard {shard} of a batch of 6 jobs\n", result.stdout.decode())
        for variables in ({}, {"ARRAY_TASK_ID": "7"}, {"ARRAY_TASK_ID": "x", "ARRAY_TASK_COUNT": "4"},
                          {"ARRAY_TASK_ID": "9", "ARRAY_TASK_MIN": "5", "ARRAY_TASK_COUNT": "4"},
                          {"PROCID": "8", "STEP_NUM_TASKS": "8"}, {"PROCID": "0", "STEP_NUM_TASKS": "1"}):
            self.assert_refused(self.slurm(**variables), 2, "--shard slurm")

    def test_mpi(self):
        def shard_of(**variables):
            environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMI_"))}
            return self.run_in("batch", *self.names, "-d", "out", *SMALL, "--shard", "mpi", env={**environment, **variables})
        for variables, shard in (({"OMPI_COMM_WORLD_RANK": "2", "OMPI_COMM_WORLD_SIZE": "4"}, "3 of 4"),
                                 ({"PMI_RANK": "0", "PMI_SIZE": "2"}, "1 of 2")):
            result = shard_of(**variables)
            self.assert_status(result, 0)
            self.assertIn(f"shard {shard} of a batch of 6 jobs\n", result.stdout.decode())
        for variables in ({}, {"PMI_RANK": "0"}, {"OMPI_COMM_WORLD_SIZE": "4"}, {"PMI_RANK": "2", "PMI_SIZE": "2"},
                          {"OMPI_COMM_WORLD_RANK": "-1", "OMPI_COMM_WORLD_SIZE": "4"},
                          {"OMPI_COMM_WORLD_RANK": "0", "OMPI_COMM_WORLD_SIZE": "99999999"}):
            self.assert_refused(shard_of(**variables), 2, "--shard mpi")

    @unittest.skipUnless(launcher(), "there is no mpirun")
    def test_mpirun(self):
        """Three processes make each scene once, and their reports are one."""
        batch = shlex.join([cli.PROGRAM, "batch", *self.names, "-d", "out", *SMALL, "--shard", "mpi", "--json"])
        command = [*launcher(), "-n", "3", "sh", "-c", f"{batch} > $$.json"]
        allowed = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        result = subprocess.run(command, cwd=self.folder, env=allowed, capture_output=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        reports = glob.glob(self.path("*.json"))
        result = self.run_in("batch", "--merge-reports", *reports)
        self.assert_status(result, 0)
        lines = [json.loads(line) for line in result.stdout.decode().splitlines()]
        self.assertEqual([line["outcome"] for line in lines[:-1]], 6 * ["made"])
        self.assertEqual((lines[-1]["merged"], lines[-1]["shards"], lines[-1]["made"]), (3, 3, 6))

    def test_the_report_says_it(self):
        outcomes = self.batch(*self.names, "-d", "out", *SMALL, "--shard", "2/3", "--junit", "r.xml")
        summary = outcomes[None]
        self.assertEqual((summary["shard"], summary["shards"], summary["all_jobs"]), (2, 3, 6))
        suite = xml.fromstring(self.read("r.xml"))
        said = {p.get("name"): p.get("value") for p in suite.iter("property")}
        self.assertEqual(said, {"version": summary["version"], "batch": summary["batch"], "shard": "2", "shards": "3",
                                "all_jobs": "6"})

    @needs_hashes
    def test_a_shard_is_killed(self):
        """Made again it goes on where it was; the others and the report are those of an undisturbed run."""
        names = self.many(20, text="union(blend = 0.1) for (i = [0 : 40]) translate([i / 8, {r}, {n}]) sphere(r = {r});\n")
        command = ["batch", *names, "-d", "out", "-r", "24", "--junit"]
        self.batch(*names, "-d", "whole", "-r", "24")
        process = subprocess.Popen([cli.PROGRAM, *command, "2.xml", "--shard", "2/2"], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not os.path.exists(self.path("out")) or (len(self.outputs()) < 3 and process.poll() is None):
            time.sleep(0.0005)
        process.kill()
        process.wait()
        self.assert_status(self.run_in(*command, "1.xml", "--shard", "1/2"), 0)
        if not os.path.exists(self.path("2.xml")): # it was not too late
            self.assertIn("shard 2 of 2 is missing", self.run_in("batch", "--merge-reports", "1.xml", "-o", "all.xml").stderr)
        result = self.run_in(*command, "2.xml", "--shard", "2/2")
        self.assert_status(result, 0)
        self.assertIn("up to date", result.stdout.decode())
        self.assert_status(self.run_in("batch", "--merge-reports", "1.xml", "2.xml", "-o", "all.xml"), 0)
        self.assertEqual(digest(self.outputs()), digest(self.outputs("whole")))

    def test_the_files_of_all_are_those_of_one(self):
        self.batch(*self.names, "-d", "whole", *SMALL)
        for i in range(3):
            self.batch(*self.names, "-d", "out", *SMALL, "--shard", f"{i + 1}/3")
        self.assertEqual(digest(self.outputs()), digest(self.outputs("whole")))


class Merged(ShardTest):
    """Reports of three shards, as JSON and as JUnit XML."""
    COUNT = 9
    KINDS = ("json", "xml")

    def setUp(self):
        super().setUp()
        if not cli.has_library("nlohmann-json"):
            self.KINDS = ("xml",) # pylint: disable=invalid-name
        self.write("s/a4.txt", "sphere(r = );\n")
        self.reports("r", *self.names)

    def reports(self, name, *arguments, count=3, options=()):
        for i in range(1, count + 1):
            result = self.run_in("batch", *arguments, "-d", "out", *SMALL, *options, "--shard", f"{i}/{count}", "--json",
                                 "--junit", f"{name}{i}.xml")
            self.write(f"{name}{i}.json", result.stdout)

    def merge(self, *reports, status):
        result = self.run_in("batch", "--merge-reports", *reports, "-o", "merged")
        self.assert_clean(result)
        self.assert_status(result, status)
        return result.stderr

    def read_lines(self, name):
        return [json.loads(line) for line in self.read(name).splitlines()]

    @staticmethod
    def bare(lines):
        """Without what differs from run to run."""
        times = ("seconds", "cpu_seconds", "number")
        return [{key: value for key, value in line.items() if key not in times} for line in lines]

    @cli.unittest.skipUnless(cli.has_library("nlohmann-json"), "no JSON in this build")
    def test_json_is_that_of_one_machine(self):
        self.assertEqual(self.merge("r3.json", "r1.json", "r2.json", status=1), "")
        self.write("whole.json", self.run_in("batch", *self.names, "-d", "whole", *SMALL, "--json").stdout)
        merged, whole = self.read_lines("merged"), self.read_lines("whole.json")
        for line in whole[:-1]:
            for output in line.get("outputs", []):
                output["file"] = output["file"].replace("whole/", "out/")
        self.assertEqual(self.bare(merged[:-1]), self.bare(whole[:-1])) # in the order of the list
        self.assertEqual([line["number"] for line in merged[:-1]], list(range(1, 10)))
        for key in ("jobs", "made", "failed", "not_run", "all_jobs", "version"):
            self.assertEqual(merged[-1][key], whole[-1][key], key)
        self.assertEqual((merged[-1]["shards"], merged[-1]["merged"]), (3, 3))
        self.assertNotIn("missing_shards", merged[-1])
        self.assertEqual(len(self.share("1/2", "--times", "merged")) + len(self.share("2/2", "--times", "merged")), 9)
        self.assert_refused(self.run_in("batch", "--merge-reports", "merged"), 1, "merged has been merged already")

    def test_junit_is_that_of_one_machine(self):
        self.assertEqual(self.merge("r2.xml", "r1.xml", "r3.xml", status=1), "")
        self.run_in("batch", *self.names, "-d", "out", *SMALL, "--junit", "whole")
        merged, whole = (xml.fromstring(self.read(name)) for name in ("merged", "whole"))
        for name in ("tests", "failures", "errors", "skipped"):
            self.assertEqual(merged.get(name), whole.get(name))
        cases = [{(case.get("classname"), case.get("name"), case.findtext("failure")) for case in suite.iter("testcase")}
                 for suite in (merged, whole)]
        self.assertEqual(cases[0], cases[1])
        self.assertEqual(len(cases[0]), 9)
        self.assertGreater(float(merged.get("time")), 0)

    def test_a_missing_shard(self):
        for kind in self.KINDS:
            said = self.merge(f"r1.{kind}", f"r3.{kind}", status=2)
            missing = 9 - len(self.share("1/3")) - len(self.share("3/3"))
            self.assertEqual(said, f"csgmesh: error: shard 2 of 3 is missing, with {missing} of 9 jobs\n")
            self.assertIn(b"a", self.read("merged")) # what is there is told all the same
        self.assertIn("shards 2, 3 of 3 are missing", self.merge(f"r1.{kind}", status=2))
        if "json" in self.KINDS:
            self.merge("r1.json", status=2)
            self.assertEqual(self.read_lines("merged")[-1]["missing_shards"], [2, 3])

    def assert_nothing(self, words, *reports):
        said = self.merge(*reports, status=1)
        self.assertEqual(said.count("error"), 1, said)
        self.assertIn(words, said)
        self.assertFalse(os.path.exists(self.path("merged")))

    def test_a_shard_twice(self):
        for kind in self.KINDS:
            self.write(f"again.{kind}", self.read(f"r2.{kind}"))
            self.assert_nothing(f"r2.{kind} and again.{kind} are both of shard 2 of 3", f"r1.{kind}", f"r2.{kind}",
                                f"again.{kind}", f"r3.{kind}")

    def test_a_job_twice(self):
        for kind in self.KINDS:
            lines = self.read(f"r1.{kind}").splitlines(keepends=True)
            first = next(line for line in lines if b"a" in line and (b'"job":' in line or b"<testcase" in line)
                         and b"failure" not in line and b'"failed"' not in line)
            other = self.read(f"r2.{kind}").decode()
            if kind == "json":
                other = first.decode() + other.replace('"jobs": ', '"jobs": 1') # more than there are
                jobs = len(self.share("2/3"))
                other = other.replace(f'"jobs": 1{jobs}', f'"jobs": {jobs + 1}')
            else:
                jobs = len(self.share("2/3"))
                other = other.replace(f'tests="{jobs}"', f'tests="{jobs + 1}"')
                other = other.replace("  </properties>\n", "  </properties>\n" + first.decode())
            self.write(f"other.{kind}", other)
            self.assert_nothing("have the same job", f"r1.{kind}", f"other.{kind}", f"r3.{kind}")

    def test_another_version(self):
        for kind in self.KINDS:
            version = json.loads(self.run_in("batch", self.names[0], "-d", "out", *SMALL, "--json").stdout.splitlines()[-1])["version"]
            self.write(f"old.{kind}", self.read(f"r2.{kind}").replace(f'"{version}"'.encode(), b'"0.0.9"'))
            self.assert_nothing(f"old.{kind} by csgmesh 0.0.9", f"r1.{kind}", f"old.{kind}", f"r3.{kind}")

    def test_another_batch(self):
        self.reports("fewer", *self.names[1:])
        self.reports("finer", *self.names, options=["-r", "7"])
        self.reports("more", *self.names, count=4)
        for kind in self.KINDS:
            for name in ("fewer2", "finer2", "more2"):
                self.assert_nothing(f"r1.{kind} and {name}.{kind} are of different batches", f"r1.{kind}", f"{name}.{kind}")
        if "json" in self.KINDS:
            self.assert_nothing("r1.json is JSON and r2.xml is JUnit XML", "r1.json", "r2.xml")

    def test_half_a_report(self):
        for kind in self.KINDS:
            whole = self.read(f"r2.{kind}")
            for length in (0, len(whole) // 2, whole.rindex(b"\n", 0, -1) + 1, len(whole) - 3):
                self.write(f"half.{kind}", whole[:length])
                self.assert_nothing(f"half.{kind}", f"r1.{kind}", f"half.{kind}", f"r3.{kind}")

    def test_usage(self):
        for arguments, words in ((["--merge-reports"], "no reports"), (["--merge-reports", "r1.xml", "-d", "out"], "exclude"),
                                 (["--merge-reports", "none.xml"], "none.xml"), ([*self.names, "-d", "out", "-o", "x"], "-o is for"),
                                 (["--merge-reports", "r1.xml", "r2.xml", "-o", "./r2.xml"], "would overwrite")):
            before = self.read("r2.xml")
            self.assert_refused(self.run_in("batch", *arguments), 2, words)
            self.assertEqual(self.read("r2.xml"), before)
        self.assert_status(self.run_in("batch", "--merge-reports", "r1.xml", "r2.xml", "r3.xml", "-o", "/dev/full"), 2)


if __name__ == "__main__":
    cli.main()
