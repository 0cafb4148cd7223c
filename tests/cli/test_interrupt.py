# SPDX-License-Identifier: MIT
"""Ctrl-C and SIGTERM: the program ends at once, with status 2, and leaves nothing behind."""
import fcntl
import os
import signal
import subprocess
import time

import cli

# A sanitizer's process takes longer to go away than the work takes to stop.
PATIENCE_S = 2.0 if cli.SANITIZED else 0.1


def as_from_a_terminal():
    """Under nohup the program would rightly go on after SIGHUP."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


class Interrupt(cli.CliTest):
    def interrupted(self, *arguments, number=signal.SIGINT, after_s=0.4):
        begun = set(os.listdir(self.folder))
        process = subprocess.Popen([cli.PROGRAM, *arguments], cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, preexec_fn=as_from_a_terminal)
        time.sleep(after_s)
        self.assertIsNone(process.poll(), "the work ended before it could be interrupted")
        sent = time.monotonic()
        process.send_signal(number)
        _, message = process.communicate(timeout=30)
        took = time.monotonic() - sent
        self.assertEqual(process.returncode, 2, message)
        self.assertIn(b"interrupted", message)
        self.assertLess(took, PATIENCE_S)
        self.assertEqual(set(os.listdir(self.folder)), begun)

    def test_while_meshing(self):
        self.write("a.txt", cli.BLEND)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.interrupted("a.txt", "--no-prune", "-r", "3000", "-o", "a.ply", number=number)

    def test_while_evaluating(self):
        self.write("a.txt", cli.ENDLESS)
        self.interrupted("a.txt", "-o", "a.ply")

    def test_while_writing(self):
        """A full pipe holds the writer until it is interrupted."""
        self.write("a.txt", cli.BALL)
        read, write = os.pipe()
        process = subprocess.Popen([cli.PROGRAM, "a.txt", "-r", "64", "-f", "obj", "-o", "-"],
                                   cwd=self.folder, stdin=subprocess.DEVNULL, stdout=write,
                                   stderr=subprocess.PIPE)
        os.close(write)
        time.sleep(1)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        _, message = process.communicate(timeout=30)
        os.close(read)
        self.assertEqual(process.returncode, 2, message)
        self.assertIn(b"interrupted", message)

    def killed_at_a_pipe(self, *outputs):
        """One output is complete, the other is a pipe: the run is killed when it has opened that."""
        os.mkfifo(self.path("pipe"))
        with subprocess.Popen([cli.PROGRAM, "a.txt", "-r", "64", "-f", "obj", "-o", *outputs, "-o", "pipe"],
                              cwd=self.folder, stderr=subprocess.DEVNULL) as process:
            with open(self.path("pipe"), "rb") as pipe:  # it waits for the writer
                pipe.read(1)
                process.kill()
                process.wait()
        self.assertEqual(process.returncode, -signal.SIGKILL)
        os.remove(self.path("pipe"))

    def test_nothing_is_left_of_a_killed_run(self):
        self.write("a.txt", cli.BALL)
        self.write("old.ply", "old")
        self.killed_at_a_pipe("new.ply", "-o", "old.ply")
        left = [name for name in os.listdir(self.folder) if name not in ("a.txt", "old.ply")]
        self.assertTrue(all(name.startswith(".csgmesh-") for name in left), left)
        if self.has_nameless_files():
            self.assertEqual(left, [])
        self.assertEqual(self.read("old.ply"), b"old")
        self.assert_status(self.run_in("a.txt", "-r", "8", "-o", "new.ply"), 0)
        self.assert_files("a.txt", "old.ply", "new.ply")

    def has_nameless_files(self):
        try:
            os.close(os.open(self.folder, os.O_TMPFILE | os.O_RDWR))
            return os.path.exists("/proc/self/fd")
        except (AttributeError, OSError):
            return False

    def test_the_next_run_sweeps(self):
        """Hidden files that no process holds go; those that one holds, and all others, stay."""
        self.write("a.txt", cli.BALL)
        dead, held = cli.hidden_name(1), cli.hidden_name(2)
        other = ".csgmesh-1-0.tmp"
        for name in (dead, held, other):
            self.write(name, "half")
        with open(self.path(held), "rb") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            self.assert_status(self.run_in("a.txt", "-r", "8", "-o", "b.ply"), 0)
            self.assert_files("a.txt", "b.ply", held, other)
        self.assert_status(self.run_in("a.txt", "-r", "8", "-o", "b.ply"), 0)
        self.assert_files("a.txt", "b.ply", other)

    def old_file_survives(self, name):
        self.write("a.txt", cli.BALL)
        self.assert_status(self.run_in("a.txt", "-r", "128", "-o", "new" + name), 0)
        whole = self.read("new" + name)
        for step in range(20):
            self.write("out" + name, b"old")
            process = subprocess.Popen([cli.PROGRAM, "a.txt", "-r", "128", "-o", "out" + name],
                                       cwd=self.folder, stderr=subprocess.DEVNULL)
            time.sleep(0.004 * step)
            process.send_signal(signal.SIGTERM)
            process.wait(timeout=30)
            self.assertIn(self.read("out" + name), (b"old", whole))
            self.assert_files("a.txt", "new" + name, "out" + name)

    def test_old_file_survives_at_any_moment(self):
        """Interrupted at many moments: the output is the old file or the whole new one."""
        self.old_file_survives(".ply")

    def test_old_file_survives_while_text_is_written(self):
        self.old_file_survives(".obj")


if __name__ == "__main__":
    cli.main()
