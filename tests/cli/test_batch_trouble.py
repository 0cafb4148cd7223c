# SPDX-License-Identifier: MIT
"""csgmesh batch in a hostile world: killed, interrupted, no room, no rights, two at once. No half file,
no lost result, a clear message and the right exit status.
"""
import glob
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import cli
from batch_support import BatchTest, digest, needs_hashes

NOBODY = 65534
SLOW = "union(blend = 0.1) for (i = [0 : 40]) translate([i / 8, {r}, {n}]) sphere(r = {r});\n"


class TroubleTest(BatchTest):
    def setUp(self):
        super().setUp()
        os.chmod(self.folder, 0o777)

    def start(self, *arguments):
        return subprocess.Popen([cli.PROGRAM, "batch", *arguments], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def assert_whole(self, wanted):
        """Every mesh is that of an undisturbed run, or is not there; nothing else is."""
        found = self.outputs()
        for name, content in digest(found).items():
            self.assertIn(name, wanted, "something is left behind")
            self.assertEqual(content, wanted[name], f"{name} is not whole")
        return found

    def leftovers(self):
        return glob.glob(self.path("out/**/.csgmesh-*.tmp"), recursive=True) + \
            glob.glob(self.path("out/.csgmesh-cache/.csgmesh-*.tmp"))


class Killed(TroubleTest):
    COUNT = 40

    def setUp(self):
        super().setUp()
        self.many(self.COUNT, text=SLOW)
        self.batch("s/*.txt", "-d", "clean", "-r", "24")
        self.wanted = digest(self.outputs("clean"))

    def stop_in_the_middle(self, number):
        """Sends the signal once some files are there and others are not; again where the batch was quicker, as it may
        be on a busy machine that leaves this process waiting."""
        for _ in range(30):
            shutil.rmtree(self.path("out"), ignore_errors=True)
            process = self.start("s/*.txt", "-d", "out", "-r", "24")
            while len(glob.glob(self.path("out/*.glb"))) < 5 and process.poll() is None:
                time.sleep(0.0005)
            process.send_signal(number)
            process.communicate()
            if process.returncode != 0:
                break
        return process.returncode

    @needs_hashes
    def test_kill_and_resume(self):
        self.assertEqual(self.stop_in_the_middle(signal.SIGKILL), -signal.SIGKILL)
        early = {n: c for n, c in self.outputs().items() if n.endswith(".glb")}
        for name, content in digest(early).items():
            self.assertEqual(content, self.wanted[name])
        # what a killed process was writing, as the library names it
        self.write("out/" + cli.hidden_name(0), "half")
        outcomes = self.batch("s/*.txt", "-d", "out", "-r", "24")
        self.assertGreaterEqual(outcomes[None]["up_to_date"], min(len(early), 5) - 2)
        self.assertEqual(len(self.assert_whole(self.wanted)), self.COUNT)
        self.assertEqual(self.leftovers(), [])

    def test_interrupt(self):
        self.assertEqual(self.stop_in_the_middle(signal.SIGINT), 2)
        self.assert_whole(self.wanted)
        self.assertEqual(self.leftovers(), [])

    @needs_hashes
    def test_many_kills(self):
        for _ in range(4):
            process = self.start("s/*.txt", "-d", "out", "-r", "24")
            time.sleep(0.05)
            process.kill()
            process.communicate()
        self.batch("s/*.txt", "-d", "out", "-r", "24")
        self.assertEqual(len(self.assert_whole(self.wanted)), self.COUNT)
        self.assertEqual(self.batch("s/*.txt", "-d", "out", "-r", "24")[None]["up_to_date"],
                         self.COUNT)


class TwoAtOnce(TroubleTest):
    def test_one_directory(self):
        self.many(40, text=SLOW)
        self.batch("s/*.txt", "-d", "clean", "-r", "20")
        wanted = digest(self.outputs("clean"))
        both = [self.start("s/*.txt", "-d", "out", "-r", "20", "--json") for _ in range(2)]
        made = 0
        for process in both:
            out, err = process.communicate()
            self.assertEqual((process.returncode, err), (0, b""))
            made += cli.json.loads(out.splitlines()[-1])["made"]
        self.assertEqual(digest(self.outputs()), wanted)
        self.assertEqual(self.leftovers(), [])
        if cli.has_library("libb2"):
            self.assertEqual(made, 40, "a job was made twice")

    def test_one_cache(self):
        self.many(30)
        both = [self.start("s/*.txt", "-d", f"out{i}", "-r", "12", "--cache", "cache")
                for i in range(2)] if cli.has_library("libb2") else []
        for process in both:
            _, errors = process.communicate()
            self.assertEqual(process.returncode, 0, errors)
        self.assertEqual(self.outputs("out0"), self.outputs("out1"))


class NoRoom(TroubleTest):
    def test_file_size_limit(self):
        self.many(3)
        self.write("small.txt", "polyhedron([[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "
                                "[[0,2,1],[0,1,3],[1,2,3],[2,0,3]]);\n")
        command = f"ulimit -f 1; exec '{cli.PROGRAM}' batch s/*.txt -d out -r 40"
        result = subprocess.run(["sh", "-c", command], cwd=self.folder, capture_output=True,
                                text=True, check=False)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("failed: "), 3)
        self.assertEqual(result.stderr.count("File too large"), 3)
        self.assertEqual((self.outputs(), self.leftovers()), ({}, []))

    @unittest.skipUnless(os.geteuid() == 0, "mounting wants root")
    def test_full_disk(self):
        os.mkdir(self.path("out"))
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs",
                                  self.path("out")], capture_output=True, check=False)
        if mounted.returncode:
            self.skipTest("no tmpfs can be mounted here")
        self.addCleanup(subprocess.run, ["umount", self.path("out")], check=False)
        names = self.many(12)
        result = self.run_in("batch", *names, "-d", "out", "-r", "32")
        self.assert_status(result, 2)
        self.assertIn("No space left on device", result.stderr)
        self.assertEqual(self.leftovers(), [])
        for name, content in self.outputs().items():
            self.run_in(f"s/{name[:-4]}.txt", "-r", "32", "-o", name)
            self.assertEqual(content, self.read(name))
        self.assertGreater(len(self.outputs()), 0)


@unittest.skipUnless(os.geteuid() == 0, "root takes away rights")
class NoRights(TroubleTest):
    def batch_as_nobody(self, *arguments):
        return subprocess.run([cli.PROGRAM, "batch", *arguments], cwd=self.folder, user=NOBODY,
                              group=NOBODY, extra_groups=[], capture_output=True, text=True,
                              check=False, env={**os.environ, "GCOV_PREFIX": self.counts})

    def setUp(self):
        super().setUp()
        # A build that counts which lines run says so on standard error where it may not write its counts.
        self.counts = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.counts)
        os.chmod(self.counts, 0o777)
        self.many(3)
        try:
            self.batch_as_nobody("--version")
        except PermissionError:
            self.skipTest("others may not run the program where it is")

    def test_unreadable_scene(self):
        os.chmod(self.path("s/a1.txt"), 0)
        result = self.batch_as_nobody("s/a0.txt", "s/a1.txt", "s/a2.txt", "-d", "out", "-r", "8")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("failed: s/a1.txt\n", result.stderr)
        self.assertIn("Permission denied", result.stderr)
        self.assertEqual(sorted(self.outputs()), ["a0.glb", "a2.glb"])

    def test_directory_without_rights(self):
        os.mkdir(self.path("out"), 0o755)
        result = self.batch_as_nobody("s/a0.txt", "-d", "out", "-r", "8")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr, "csgmesh: error: cannot write out: Permission denied\n")
        self.assertEqual(os.listdir(self.path("out")), [])

    def test_no_directory_can_be_made(self):
        os.mkdir(self.path("locked"), 0o755)
        result = self.batch_as_nobody("s/a0.txt", "-d", "locked/out", "-r", "8")
        self.assertEqual(result.returncode, 2)
        self.assertIn("cannot write locked/out: Permission denied", result.stderr)

    def test_directory_that_is_a_file(self):
        self.write("out", "mine")
        result = self.run_in("batch", "s/a0.txt", "-d", "out", "-r", "8")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr, "csgmesh: error: cannot write out: Not a directory\n")
        self.assertEqual(self.read("out"), b"mine")

    def test_cache_without_rights(self):
        os.mkdir(self.path("cache"), 0o755)
        result = self.batch_as_nobody("s/a0.txt", "-d", "out", "-r", "8", "--cache", "cache")
        self.assertEqual(result.returncode, 2)
        self.assertIn("cache", result.stderr)

    def test_a_file_of_another_owner(self):
        os.mkdir(self.path("out"))
        os.chmod(self.path("out"), 0o777)
        self.write("out/a0.glb", "mine")
        os.chmod(self.path("out/a0.glb"), 0o444)
        result = self.batch_as_nobody("s/a0.txt", "s/a1.txt", "-d", "out", "-r", "8")
        self.assertEqual(result.returncode, 2)
        self.assertIn("Permission denied", result.stderr)
        self.assertEqual(self.outputs()["a0.glb"], b"mine")
        self.assertIn("a1.glb", self.outputs())


class OddPlaces(TroubleTest):
    def test_the_directory_is_a_file(self):
        self.many(1)
        self.write("out", "x")
        self.assert_refused(self.run_in("batch", "s/a0.txt", "-d", "out"), 2, "out")
        self.assertEqual(self.read("out"), b"x")

    def test_an_output_is_a_directory(self):
        self.many(2)
        os.makedirs(self.path("out/a0.glb"))
        result = self.run_in("batch", "s/a0.txt", "s/a1.txt", "-d", "out", "-r", "8")
        self.assert_status(result, 2)
        self.assertIn("Is a directory", result.stderr)
        self.assertEqual(list(self.outputs()), ["a1.glb"])

    def test_a_scene_that_never_ends(self):
        self.write("endless.txt", cli.ENDLESS)
        self.write("ball.txt", cli.BALL)
        result = self.run_in("batch", "endless.txt", "ball.txt", "-d", "out", "-r", "8",
                             "--timeout", "1")
        self.assert_status(result, 2)
        self.assertEqual(list(self.outputs()), ["ball.glb"])


if __name__ == "__main__":
    cli.main()
