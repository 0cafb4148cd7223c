# SPDX-License-Identifier: MIT
"""csgmesh-mpi: many ranks write the bytes of one process, and a job that fails leaves one message and no file.

CSGMESH_MPI names the program; without it, or without mpirun, the tests are skipped. Ranks are more than there are cores.
"""
import fcntl
import json
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

import cli

PROGRAM = os.environ.get("CSGMESH_MPI", "")
STRESS = os.path.join(cli.SCENES, "stress")
RANKS = (1, 2, 4, 7)
FEW = 3
PARTS = """part("base") color("red") difference() { cube([4, 3, 1]); translate([2, 1.5, -1]) cylinder(h = 3, r = 1); }
part("nothing") intersection() { cube(1); translate([3, 0, 0]) cube(1); }
part("ball") color("blue") translate([2, 1.5, 2]) sphere(r = 0.9);
color("green") translate([0, 0, 3]) cube(0.4);
"""
# Where the tape is short there is surface in every cube, where it is long in few: work is shared out twice.
UNEVEN = """sphere(r = 1);
translate([4, 0, 0]) intersection() {
  sphere(r = 1.5);
  union(blend = 0.2) for (i = [0 : 30]) rotate([i * 20, i * 37, i * 11]) translate([1.4, 0, 0]) sphere(r = 0.05);
}
"""


def launcher():
    """mpirun with what makes it start more ranks than there are cores, also as root; None: there is none."""
    program = shutil.which("mpirun")
    if not program:
        return None
    says = subprocess.run([program, "--version"], capture_output=True, text=True, check=False).stdout
    return [program, "--quiet", "--oversubscribe"] if "Open MPI" in says else [program]


@unittest.skipUnless(PROGRAM and os.path.exists(PROGRAM), "this build has no csgmesh-mpi (it was made without MPI)")
@unittest.skipUnless(launcher(), "there is no mpirun")
class Ranks(cli.CliTest):
    def setUp(self):
        super().setUp()
        self.environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                            "OMPI_MCA_btl_base_warn_component_unused": "0", "OMPI_MCA_rmaps_base_oversubscribe": "1",
                            # what MPI itself keeps until the end is not ours
                            "ASAN_OPTIONS": "detect_leaks=0:halt_on_error=1:allocator_may_return_null=1"}

    def job(self, *groups):
        """Each group is a number of ranks and their command line."""
        line = launcher()
        for i, (count, *command) in enumerate(groups):
            line += [":"] * (i > 0) + ["-n", str(count), *map(str, command)]
        return line

    def run_job(self, *groups):
        result = subprocess.run(self.job(*groups), cwd=self.folder, env=self.environment, capture_output=True,
                                timeout=120, check=False)
        result.stderr = result.stderr.decode("utf-8", "replace")
        return result

    def make(self, count, *arguments):
        result = self.run_job((count, PROGRAM, *arguments))
        self.assert_status(result, 0)
        return result

    def compare(self, name, scene, extension, counts, *options):
        one, many = "one." + extension, "many." + extension
        if cli.SANITIZED:  # each rank goes through the same code: a few show what many do
            counts = [min(counts[-1], FEW)]
        self.assert_status(self.run_in(scene, "-o", one, *options), 0)
        for count in counts:
            with self.subTest(name, extension=extension, ranks=count):
                self.make(count, scene, "-o", many, *options)
                self.assertTrue(self.read(many) == self.read(one), f"{name}: {count} ranks make another file")
                os.unlink(self.path(many))
        os.unlink(self.path(one))

    def assert_one_message(self, result, *words):
        """Of ours: what mpirun says of the job's end comes on top."""
        ours = [line for line in result.stderr.splitlines() if re.search(r"\berror( E\d+)?: ", line)]
        self.assertNotEqual(result.returncode, 0)
        self.assertEqual(len(ours), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    # ---- the same bytes

    def test_scenes(self):
        for name, extension, counts in (("s1-sphere", "glb", (1, 2)), ("s2-twenty-blended", "ply", (4,)),
                                        ("s3-cylinder-minus-cross", "ply", RANKS), ("s4-thousand-spheres", "stl", (7,)),
                                        ("s5-gyroid", "glb", (4,))):
            self.compare(name, os.path.join(STRESS, name + ".txt"), extension, counts, "-r", 48)

    def test_formats_and_smooth(self):
        scene = os.path.join(STRESS, "s3-cylinder-minus-cross.txt")
        for extension in ("stl", "glb"):
            self.compare("smooth", scene, extension, (3,), "-r", 50, "--features", "smooth")
        self.compare("sharp", scene, "obj", (3,), "-r", 50)

    def test_parts_and_colors(self):
        self.write("parts.txt", PARTS)
        self.write("blend.txt", cli.BLEND)
        self.compare("parts", "parts.txt", "glb", (4,), "-r", 40)
        self.compare("parts", "parts.txt", "ply", (2,), "-r", 40)
        self.compare("colours", "blend.txt", "glb", (4,), "-r", 40)

    def test_cells_that_follow(self):
        """Without -r and -s, with what changes triangles after they are made, in parts and colours, for 1 to 7 ranks."""
        self.write("parts.txt", PARTS)
        self.write("blend.txt", cli.BLEND)
        self.write("bore.txt", "difference() { cube(10); cylinder(h = 30, r = 3, center = true); }\n")
        cross = os.path.join(STRESS, "s3-cylinder-minus-cross.txt")
        mug = os.path.join(cli.SCENES, "parts", "mug.txt")
        draft = ("--quality", "draft")
        for name, scene, extension, counts, *options in (("sharp", cross, "ply", (4,)), ("coarse", cross, "ply", (1, 2, 7), *draft),
                                                         ("within", "bore.txt", "ply", (7,), "-e", 0.1),
                                                         ("smooth", "bore.txt", "stl", (2,), "--features", "smooth", *draft),
                                                         ("budget", "bore.txt", "glb", (4,), "--triangles", 200),
                                                         ("curved", mug, "ply", (4,), *draft),
                                                         ("improved", "bore.txt", "obj", (2,), *draft, "--improve"),
                                                         ("equal", "bore.txt", "ply", (3,), "-r", 40, "--simplify", 0.02),
                                                         ("threads", "bore.txt", "ply", (3,), "-j", 2, *draft),
                                                         ("parts", "parts.txt", "glb", (4,), *draft),
                                                         ("colours", "blend.txt", "ply", (3,), *draft)):
            self.compare(name, scene, extension, counts, *map(str, options))

    @cli.optimised_only
    def test_tiles(self):
        """Cells that follow the shape where the limit makes each rank thin them out in tiles: another file than with all memory."""
        self.write("lattice.txt", "intersection() { cube([4, 4, 4]); gyroid(cell = 8, thickness = 1); }")
        cross = os.path.join(STRESS, "s3-cylinder-minus-cross.txt")
        for scene, limit, counts, *options in (("lattice.txt", "8M", (2, 4), "-e", "0.05"), (cross, "8M", (3, 7))):
            self.compare(f"tiles of {scene}", scene, "ply", counts, "--max-memory", limit, *options)
            self.assert_status(self.run_in(scene, "-o", "tiles.ply", "--max-memory", limit, *options), 0)
            self.assert_status(self.run_in(scene, "-o", "whole.ply", *options), 0)
            self.assertFalse(self.read("tiles.ply") == self.read("whole.ply"), "the limit asks for no tiles")

    def test_other_limits(self):
        """Which tiles there are depends on the limit: ranks with another one are told so before any work."""
        self.write("a.txt", cli.BALL)
        result = self.run_job((2, PROGRAM, "a.txt", "-o", "a.ply"), (1, PROGRAM, "a.txt", "-o", "a.ply", "--max-memory", "64M"))
        self.assert_one_message(result, "rank 2 has another scene or other options")
        self.assert_files("a.txt")

    def test_warned_once(self):
        """What is said of a mesh that all ranks have, the first says."""
        self.write("half.txt", "sphere(r = 1);\n")
        result = self.make(3, "half.txt", "-o", "a.ply", "--bounds", "-2,-2,-2,2,2,0.5", "--quality", "draft")
        self.assertEqual(result.stderr.count("warning W0402"), 1, result.stderr)

    def test_limits_of_replicated_work(self):
        """A rank that has no more time or memory ends the job: one message, no file."""
        scene = os.path.join(STRESS, "s5-gyroid.txt")
        for options, words in ((("--timeout", 0.2), "longer than the limit of 0.2 s"), (("--max-memory", "3M"), "memory")):
            with self.subTest(words):
                weak, strong = [scene, "-o", "a.ply", *options], [scene, "-o", "a.ply"]
                result = self.run_job((3, PROGRAM, *weak))
                self.assert_one_message(result, words)
                self.assert_files()

    def test_fewer_cubes_than_ranks(self):
        self.write("ball.txt", cli.BALL)
        self.compare("ball", "ball.txt", "ply", (7,), "-r", 6)

    def test_slabs(self):
        """Each rank's stretch in several slabs, under a memory limit."""
        self.compare("slabs", os.path.join(STRESS, "s1-sphere.txt"), "ply", (2,), "-r", 200, "--max-memory", "4M",
                     "--features", "smooth")

    def test_shared_again(self):
        self.write("uneven.txt", UNEVEN)
        self.compare("uneven", "uneven.txt", "ply", (4,), "-r", 150)
        stats = json.loads(self.make(4, "uneven.txt", "-r", 150, "-o", "a.ply", "--stats").stdout)
        self.assertTrue(stats["shared_again"])

    def test_stats(self):
        """Shares add up, and none is far from the mean."""
        scene = os.path.join(STRESS, "s1-sphere.txt")
        stats = json.loads(self.make(4, scene, "-r", 128, "-o", "a.ply", "--stats").stdout)
        self.assertEqual(len(stats["ranks"]), 4)
        for key in ("vertices", "triangles"):
            shares = [rank[key] for rank in stats["ranks"]]
            self.assertEqual(sum(shares), stats["mesh"][key])
            self.assertLess(max(shares), 1.3 * sum(shares) / 4, shares)
        self.assertFalse(stats["shared_again"])
        for rank in stats["ranks"][:3]:
            self.assertGreater(rank["halo_cubes"], 0)

    @cli.optimised_only
    def test_stats_of_cells_that_follow(self):
        """Each rank has its share of the work, of a mesh that all have."""
        scene = os.path.join(STRESS, "s3-cylinder-minus-cross.txt")
        stats = json.loads(self.make(3, scene, "-o", "a.ply", "--stats").stdout)
        tasks = [rank["tasks"] for rank in stats["ranks"]]
        self.assertLess(max(tasks), 1.2 * sum(tasks) / 3, tasks)
        made = [rank["triangles"] for rank in stats["ranks"]]
        self.assertLess(max(made), 1.2 * sum(made) / 3, made)
        self.assertGreater(sum(made), stats["mesh"]["triangles"]) # before they are thinned out
        self.assertGreater(min(rank["received_bytes"] for rank in stats["ranks"]), 1000)

    # ---- what it says of itself

    def test_page(self):
        """Its page reads well, and has the options of csgmesh mesh but for those that it refuses."""
        page = subprocess.run([PROGRAM, "--man"], capture_output=True, text=True, check=True).stdout
        options = re.compile(r"\\fB(\\-\\-[\w\\-]+?)\\fR")
        written = {word.replace("\\-", "-") for word in options.findall(page)}
        mesh = {word.replace("\\-", "-") for word in options.findall(cli.run("man", "mesh").stdout.decode())}
        self.assertLess(written, mesh)
        self.assertIn("--max-memory", written)
        self.write("ball.txt", cli.BALL)
        self.assertEqual(mesh - written, {"--cells", "--depfile", "--lod", "--root", "--sandbox", "--smooth", "--stats-full",
                                          "--summary", "--trace", "--watch"} & mesh)
        result = self.run_job((1, PROGRAM, "ball.txt", "-r", 20, "-o", "a.ply", "--lod", 3))
        self.assert_one_message(result, "csgmesh-mpi has no --lod")
        if shutil.which("man"):
            self.write("page.1", page)
            result = subprocess.run(["man", "--warnings", "-l", "page.1"], cwd=self.folder, capture_output=True, text=True,
                                    check=False, env={**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "80"})
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertIn("SEE ALSO", result.stdout)

    # ---- refusals and faults

    def test_refused(self):
        self.write("ball.txt", cli.BALL)
        for options, words in ((("-r", 20, "-o", "b.ply"), "one file"), (("--lod", 3), "csgmesh-mpi has no --lod"),
                               (("--resume", ), "cannot be kept")):
            with self.subTest(words):
                result = self.run_job((2, PROGRAM, "ball.txt", "-o", "a.ply", *options))
                self.assert_one_message(result, words)
                self.assert_files("ball.txt")

    def test_mistake_in_scene(self):
        self.write("bad.txt", "sphere(r = 1;\n")
        result = self.run_job((3, PROGRAM, "bad.txt", "-r", 20, "-o", "a.ply"))
        self.assertNotEqual(result.returncode, 0)
        self.assertEqual(result.stderr.count("error E0109"), 1, result.stderr)
        self.assert_files("bad.txt")

    def test_other_scene_on_one_rank(self):
        self.write("a.txt", cli.BALL)
        self.write("b.txt", "sphere(r = 1.0001);\n")
        tail = ["-r", 20, "-o", "a.ply"]
        result = self.run_job((2, PROGRAM, "a.txt", *tail), (1, PROGRAM, "b.txt", *tail))
        self.assert_one_message(result, "rank 2 has another scene or other options")
        self.assert_files("a.txt", "b.txt")

    def test_other_version_on_one_rank(self):
        """The other version is this program with another number in its bytes."""
        self.write("a.txt", cli.BALL)
        version = subprocess.run([cli.PROGRAM, "--version"], capture_output=True, check=True).stdout.split()[1]
        with open(PROGRAM, "rb") as file:
            program = file.read()
        other = version[:-1] + (b"1" if version[-1:] != b"1" else b"2")
        self.assertTrue(version + b"\0" in program)
        self.write("other", program.replace(version + b"\0", other + b"\0"))
        os.chmod(self.path("other"), 0o755)
        tail = ["a.txt", "-r", 20, "-o", "a.ply"]
        result = self.run_job((2, PROGRAM, *tail), (1, self.path("other"), *tail))
        self.assert_one_message(result, "rank 2 runs another version than rank 0", version.decode())
        self.assert_files("a.txt", "other")

    def test_full_disk_on_one_rank(self):
        """A rank that may write no further than 64 KiB into any file; Open MPI must not want one in shared memory."""
        self.environment["OMPI_MCA_btl"] = "self,tcp"
        scene = os.path.join(STRESS, "s1-sphere.txt")
        tail = [scene, "-r", 128, "-o", "a.ply"]
        for groups in ([(2, PROGRAM, *tail), (1, "bash", "-c", 'ulimit -f 64; exec "$@"', "bash", PROGRAM, *tail)],
                       [(1, "bash", "-c", 'ulimit -f 64; exec "$@"', "bash", PROGRAM, *tail), (2, PROGRAM, *tail)]):
            result = self.run_job(*groups)
            self.assert_one_message(result, "a.ply", "cannot write: File too large")
            self.assert_files()

    def test_killed_rank(self):
        scene = os.path.join(STRESS, "s5-gyroid.txt")
        for victim in (0, 2):
            with self.subTest(victim=victim):
                line = self.job((3, PROGRAM, scene, "-r", 600, "-o", "a.ply"))
                with subprocess.Popen(line, cwd=self.folder, env=self.environment, stderr=subprocess.PIPE,
                                      stdout=subprocess.DEVNULL) as job:
                    deadline = time.monotonic() + 60
                    while not all(map(self.has_file, range(3))) and time.monotonic() < deadline:
                        time.sleep(0.02)
                    self.assertTrue(os.listdir(self.folder), "no file was begun")
                    os.kill(self.process_of(victim), signal.SIGKILL)
                    _, said = job.communicate(timeout=60)
                self.assertNotEqual(job.returncode, 0)
                self.assertNotIn(b"csgmesh: ", said)
                self.assert_files()

    @cli.optimised_only
    def test_killed_rank_of_cells_that_follow(self):
        scene = os.path.join(STRESS, "s5-gyroid.txt")
        line = self.job((3, PROGRAM, scene, "--quality", "fine", "-o", "a.ply"))
        with subprocess.Popen(line, cwd=self.folder, env=self.environment, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL) as job:
            deadline = time.monotonic() + 60
            while self.seconds_of(1) < 1 and job.poll() is None and time.monotonic() < deadline:
                time.sleep(0.02)
            os.kill(self.process_of(1), signal.SIGKILL)
            _, said = job.communicate(timeout=60)
        self.assertNotEqual(job.returncode, 0)
        self.assertNotIn(b"csgmesh: ", said)
        self.assert_files()

    # ---- going on

    def kill_when(self, condition, victim, count, *arguments):
        """Kills a rank of a job as soon as something holds of the test's folder; whether it was still running."""
        line = self.job((count, PROGRAM, *arguments))
        with subprocess.Popen(line, cwd=self.folder, env=self.environment, stderr=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL) as job:
            deadline = time.monotonic() + 60
            while not condition() and job.poll() is None and time.monotonic() < deadline:
                time.sleep(0.002)
            try:
                os.kill(self.process_of(victim), signal.SIGKILL)
            except (self.failureException, ProcessLookupError):
                pass
            job.communicate(timeout=60)
        return job.returncode != 0

    def size(self, name):
        try:
            return os.stat(self.path(name)).st_size
        except FileNotFoundError:
            return 0

    def resumed(self, stats):
        return [rank["resumed_cubes"] for rank in stats["ranks"]]

    def test_killed_and_resumed(self):
        """Killed while it counts and while it makes, then gone on with: the bytes of one process, and the folder is gone."""
        self.write("lattice.txt", "intersection() { cube([10, 10, 10]); gyroid(cell = 4, thickness = 0.6); }")
        self.write("uneven.txt", UNEVEN)
        for scene, extension, cells in (("lattice.txt", "ply", 96), ("uneven.txt", "glb", 150)):
            out, one, kept = "a." + extension, "one." + extension, f"a.{extension}.resume"
            self.assert_status(self.run_in(scene, "-o", one, "-r", str(cells)), 0)
            arguments = (scene, "-o", out, "-r", cells, "--max-memory", "14M", "--resume")
            stopped = 0
            for victim, condition in ((2, lambda: self.size(kept + "/rank-1") > 4000), (0, lambda: self.size(kept + "/mesh") > 0),
                                      (1, lambda: self.size(kept + "/mesh") > 100000)):
                if self.kill_when(condition, victim, 3, *arguments):
                    stopped += 1
                    self.assertFalse(os.path.exists(self.path(out)))
                    self.assertTrue(os.path.exists(self.path(kept + "/head")))
                elif os.path.exists(self.path(out)):
                    os.unlink(self.path(out))
            stats = json.loads(self.make(3, *arguments, "--stats").stdout)
            self.assertTrue(self.read(out) == self.read(one), f"{scene} {extension}")
            self.assertFalse(os.path.exists(self.path(kept)))
            if stopped == 3: # else the last was done before it could be killed
                self.assertGreater(sum(self.resumed(stats)), 0)
            for name in (out, one):
                os.unlink(self.path(name))

    def test_time_limit_and_resumed(self):
        """A job that stops itself keeps what it has, too, and may go on with other limits; without anything kept all is gone."""
        scene = os.path.join(STRESS, "s5-gyroid.txt")
        cells = "120" if cli.SANITIZED else "240"  # either way much more than the limit has time for
        result = self.run_job((3, PROGRAM, scene, "-r", cells, "-o", "a.ply", "--resume", "--timeout", 0.1, "--max-memory", "64M"))
        self.assert_one_message(result, "longer than the limit of 0.1 s")
        self.assert_files("a.ply.resume")
        self.make(3, scene, "-r", cells, "-o", "a.ply", "--resume")
        self.assert_status(self.run_in(scene, "-r", cells, "-o", "b.ply"), 0)
        self.assertTrue(self.read("a.ply") == self.read("b.ply"))
        self.assert_files("a.ply", "b.ply")
        result = self.run_job((3, PROGRAM, scene, "-r", 40, "-o", "a.obj", "--resume"))
        self.assert_one_message(result, "cannot be kept")
        self.assert_files("a.ply", "b.ply")

    def test_not_resumed(self):
        self.write("a.txt", cli.BALL)
        self.write("b.txt", "sphere(r = 1.0001);\n")
        os.mkdir(self.path("a.ply.resume"))
        self.write("a.ply.resume/mesh", "")
        tail = ("-r", 20, "-o", "a.ply", "--resume")
        # what a killed job has left: its head is of this scene
        self.assertTrue(self.kill_when(lambda: self.size("c.ply.resume/head") > 0, 1, 2, os.path.join(STRESS, "s5-gyroid.txt"),
                                       "-r", 600, "-o", "c.ply", "--resume"))
        other = ("-o", "c.ply", "--resume", "-r")
        for count, arguments, words in ((2, ("a.txt", *other, 600), "is of another scene"),
                                        (3, (os.path.join(STRESS, "s5-gyroid.txt"), *other, 600), "another number of ranks"),
                                        (2, (os.path.join(STRESS, "s5-gyroid.txt"), *other, 601), "other options")):
            with self.subTest(words):
                result = self.run_job((count, PROGRAM, *arguments))
                self.assert_one_message(result, "cannot resume from c.ply.resume", words, "remove the folder")
                self.assertGreater(self.size("c.ply.resume/head"), 0)
        with open(self.path("c.ply.resume/head"), "r+", encoding="utf-8") as head:
            fcntl.flock(head, fcntl.LOCK_EX)
            result = self.run_job((2, PROGRAM, os.path.join(STRESS, "s5-gyroid.txt"), *other, 600))
            self.assert_one_message(result, "another job works with it")
            head.truncate(10)
        result = self.run_job((2, PROGRAM, os.path.join(STRESS, "s5-gyroid.txt"), *other, 600))
        self.assert_one_message(result, "no job of csgmesh-mpi")
        result = self.run_job((1, PROGRAM, "a.txt", "-r", 20, "-o", "d.ply", "--resume"))
        self.assert_one_message(result, "two ranks or more")
        self.make(2, "a.txt", *tail) # a folder without a word in it is begun anew
        self.assert_files("a.txt", "b.txt", "a.ply", "c.ply.resume")

    def seconds_of(self, rank):
        """Its processor time in user mode; 0 before it is there."""
        try:
            with open(f"/proc/{self.process_of(rank)}/stat", encoding="ascii") as file:
                return int(file.read().rpartition(")")[2].split()[11]) / os.sysconf("SC_CLK_TCK")
        except (self.failureException, OSError):
            return 0

    def has_file(self, rank):
        """Whether a rank has opened the file that all write to: from then on each of them removes it when it is ended."""
        try:
            files = f"/proc/{self.process_of(rank)}/fd"
            return any(os.readlink(os.path.join(files, one)).startswith(os.path.realpath(self.folder) + "/.csgmesh")
                       for one in os.listdir(files))
        except (OSError, self.failureException):
            return False

    def process_of(self, rank):
        """The process that is this rank of the job in the test's folder."""
        for name in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{name}/environ", "rb") as file:
                    environment = file.read().split(b"\0")
                if os.readlink(f"/proc/{name}/cwd") == os.path.realpath(self.folder) and any(
                        word in environment for word in (b"OMPI_COMM_WORLD_RANK=%d" % rank, b"PMI_RANK=%d" % rank)):
                    return int(name)
            except OSError:
                continue
        raise self.failureException("no such rank")


if __name__ == "__main__":
    cli.main()
