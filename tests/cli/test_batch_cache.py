# SPDX-License-Identifier: MIT
"""csgmesh batch --cache DIR, as a file system that many machines share has it: entries that are cut off, changed or
something else, writers that are killed, a full disk, no locks. What is taken from the cache is what would have been made,
whatever has become of it.
"""
import os
import random
import shlex
import shutil
import signal
import subprocess
import time
import unittest

import cli
from batch_support import BatchTest, digest, needs_hashes

SMALL = ["-r", "8"]
SLOW = "union(blend = 0.1) for (i = [0 : 30]) translate([i / 8, {r}, {n}]) sphere(r = {r});\n"

# A file system as NFS without its lock server: no locks, no files without a name. HOST: another machine's name.
SHIM = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/utsname.h>

static int opened(const char *name, const char *path, int flags, mode_t mode)
{
    int (*next)(const char *, int, ...) = (int (*)(const char *, int, ...))dlsym(RTLD_NEXT, name);
    if ((flags & O_TMPFILE) == O_TMPFILE) {
        errno = EOPNOTSUPP;
        return -1;
    }
    return next(path, flags, mode);
}
#define OPEN(name)                                                                                 \
    int name(const char *path, int flags, ...)                                                     \
    {                                                                                              \
        va_list list;                                                                              \
        va_start(list, flags);                                                                     \
        mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(list, mode_t) : 0;                    \
        va_end(list);                                                                              \
        return opened(#name, path, flags, mode);                                                   \
    }
OPEN(open) OPEN(open64)

static int controlled(const char *name, int fd, int command, void *argument)
{
    int (*next)(int, int, ...) = (int (*)(int, int, ...))dlsym(RTLD_NEXT, name);
    if (command == F_OFD_SETLK || command == F_OFD_SETLKW || command == F_SETLK || command == F_SETLKW) {
        errno = ENOLCK;
        return -1;
    }
    return next(fd, command, argument);
}
#define CONTROL(name)                                                                              \
    int name(int fd, int command, ...)                                                             \
    {                                                                                              \
        va_list list;                                                                              \
        va_start(list, command);                                                                   \
        void *argument = va_arg(list, void *);                                                     \
        va_end(list);                                                                              \
        return controlled(#name, fd, command, argument);                                           \
    }
CONTROL(fcntl) CONTROL(fcntl64)

int flock(int fd, int operation)
{
    (void)fd, (void)operation;
    errno = ENOLCK;
    return -1;
}

int uname(struct utsname *system)
{
    int (*next)(struct utsname *) = (int (*)(struct utsname *))dlsym(RTLD_NEXT, "uname");
    int result = next(system);
    strncpy(system->nodename, getenv("HOST") ? getenv("HOST") : "", sizeof system->nodename - 1);
    return result;
}
"""


class CacheTest(BatchTest):
    def setUp(self):
        super().setUp()
        self.scenes()
        self.taken = 0

    def wanted_of(self, *scenes, options=()):
        self.batch(*scenes, "-d", "wanted", *options)
        return digest(self.outputs("wanted"))

    def entries(self, folder="cache"):
        return sorted(os.path.join(place, name) for place, _, names in os.walk(self.path(folder)) for name in names)

    def take(self, wanted, *scenes, folder="other", options=()):
        """Another folder takes what it can; how many jobs that was."""
        shutil.rmtree(self.path(folder), ignore_errors=True)
        summary = self.batch(*scenes, "-d", folder, "--cache", "cache", *options)[None]
        self.assertEqual(digest(self.outputs(folder)), wanted)
        return summary["cached"]


@needs_hashes
class Broken(CacheTest):
    SCENES = ("mug.txt", "box.txt", "ball.txt")
    OPTIONS = ("--name", "{scene}-{part}.{ext}", *SMALL)

    def setUp(self):
        super().setUp()
        self.wanted = self.wanted_of(*self.SCENES, options=self.OPTIONS)
        self.batch(*self.SCENES, "-d", "out", "--cache", "whole", *self.OPTIONS)

    def take_broken(self, change, *files):
        shutil.rmtree(self.path("cache"), ignore_errors=True)
        shutil.copytree(self.path("whole"), self.path("cache"))
        for file in files:
            change(file.replace(self.path("whole"), self.path("cache")))
        taken = self.take(self.wanted, *self.SCENES, options=self.OPTIONS)
        # what was broken is whole again, or does no harm
        self.assertEqual(self.take(self.wanted, *self.SCENES, options=self.OPTIONS), 3, files)
        return taken

    def test_each_entry_cut_off(self):
        for file in self.entries("whole"):
            size = os.path.getsize(file)
            for length in (0, size // 2, size - 1):
                self.assertEqual(self.take_broken(lambda path, length=length: os.truncate(path, length), file), 2, file)

    def test_each_entry_changed(self):
        generator = random.Random(7)

        def change(path):
            with open(path, "r+b") as file:
                place = generator.randrange(os.path.getsize(path))
                file.seek(place)
                byte = file.read(1)[0]
                file.seek(place)
                file.write(bytes([byte ^ 1 << generator.randrange(8)]))
        for file in self.entries("whole"):
            for _ in range(cli.rounds(3)):
                self.take_broken(change, file)

    def test_another_part(self):
        """A record that says another name is none, though its outputs are whole."""
        def change(path):
            with open(path, "rb") as file:
                content = file.read()
            self.assertIn(b" glb lid\n", content)
            with open(path, "wb") as file:
                file.write(content.replace(b" glb lid\n", b" glb lod\n"))
        records = [file for file in self.entries("whole") if b" glb lid\n" in self.read(file)]
        self.assertEqual(len(records), 1)
        self.assertEqual(self.take_broken(change, *records), 2)

    def test_an_entry_for_another(self):
        objects = [file for file in self.entries("whole") if "/objects/" in file]

        def change(path):
            shutil.copy(next(file for file in objects if not file.endswith(os.path.basename(path))), path)
        for file in objects:
            self.assertEqual(self.take_broken(change, file), 2)

    def test_no_files(self):
        """Pipes, devices, folders and links to nowhere: nobody waits for them."""
        def pipe(path):
            os.remove(path)
            os.mkfifo(path)

        def folder(path):
            os.remove(path)
            os.mkdir(path)

        def link(path):
            os.remove(path)
            os.symlink("/nowhere/at/all", path)

        def device(path):
            os.remove(path)
            os.symlink("/dev/zero", path)
        for change in (pipe, folder, link, device):
            for file in self.entries("whole"):
                shutil.rmtree(self.path("cache"), ignore_errors=True)
                shutil.copytree(self.path("whole"), self.path("cache"))
                change(file.replace(self.path("whole"), self.path("cache")))
                self.assertEqual(self.take(self.wanted, *self.SCENES, options=self.OPTIONS), 2)


@needs_hashes
class Writers(CacheTest):
    COUNT = 14
    OPTIONS = ("-r", "14")

    def setUp(self):
        super().setUp()
        self.names = self.many(self.COUNT, text=SLOW)
        self.wanted = self.wanted_of(*self.names, options=self.OPTIONS)

    def start(self, folder, environment=None):
        return subprocess.Popen([cli.PROGRAM, "batch", *self.names, "-d", folder, "--cache", "cache", *self.OPTIONS],
                                cwd=self.folder, env={**os.environ, **(environment or {})}, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)

    def test_killed(self):
        """At any moment; the next one takes what is whole."""
        generator = random.Random(3)
        before = 0
        for i in range(4):
            process = self.start(f"killed{i}")
            while len(self.entries()) < before + 4 and process.poll() is None:
                time.sleep(0.0005)
            time.sleep(generator.random() * 0.01)
            process.kill()
            process.communicate()
            before = len(self.entries())
        self.assertGreater(self.take(self.wanted, *self.names, options=self.OPTIONS), 3)
        self.assertEqual(self.take(self.wanted, *self.names, options=self.OPTIONS), self.COUNT)

    def test_one_cache_for_many(self):
        processes = [self.start(f"many{i}") for i in range(4)]
        for i, process in enumerate(processes):
            _, errors = process.communicate()
            self.assertEqual((process.returncode, errors), (0, b""))
            self.assertEqual(digest(self.outputs(f"many{i}")), self.wanted)
        self.assertEqual(self.take(self.wanted, *self.names, options=self.OPTIONS), self.COUNT)

    @unittest.skipUnless(os.geteuid() == 0, "mounting wants root")
    def test_full_disk(self):
        os.mkdir(self.path("cache"))
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=150k", "tmpfs", self.path("cache")],
                                 capture_output=True, check=False)
        if mounted.returncode:
            self.skipTest("no tmpfs can be mounted here")
        self.addCleanup(subprocess.run, ["umount", self.path("cache")], check=False)
        result = self.run_in("batch", *self.names, "-d", "out", "--cache", "cache", *self.OPTIONS)
        self.assert_status(result, 0)
        self.assertEqual(result.stderr, "csgmesh: warning: the cache cache does not take all that was made: No space left on "
                         "device\n")
        self.assertEqual(digest(self.outputs()), self.wanted)
        taken = self.take(self.wanted, *self.names, options=self.OPTIONS)
        self.assertGreater(taken, 0)
        self.assertLess(taken, self.COUNT)


@needs_hashes
@unittest.skipIf(cli.SANITIZED, "sanitizers have functions of their own")
class NoLocks(Writers):
    """The same, and two machines in one folder of outputs, where locks and files without names do not work."""
    test_full_disk = test_one_cache_for_many = None

    def setUp(self):
        super().setUp()
        source, self.shim = self.write("shim.c", SHIM), self.path("shim.so")
        try:
            subprocess.run([*shlex.split(os.environ.get("CSGMESH_CC", "cc")), "-shared", "-fPIC", "-O1", "-o", self.shim,
                            self.path("shim.c"), "-ldl"], check=True, capture_output=True)
        except (OSError, subprocess.CalledProcessError):
            self.skipTest(f"{source} does not compile here")

    def machine(self, name):
        return {"LD_PRELOAD": self.shim, "HOST": name}

    def start(self, folder, environment=None):
        return super().start(folder, {**self.machine("here"), **(environment or {})})

    def test_two_machines_in_one_folder(self):
        for round_number in range(2):
            shutil.rmtree(self.path("out"), ignore_errors=True)
            shutil.rmtree(self.path("cache"), ignore_errors=True)
            machines = [self.start("out", self.machine(name)) for name in ("one", "two", "three")]
            if round_number:
                while len(self.outputs()) < 4 and machines[0].poll() is None:
                    time.sleep(0.0005)
                machines[0].send_signal(signal.SIGKILL)
            for i, process in enumerate(machines):
                _, errors = process.communicate()
                if i or not round_number:
                    self.assertEqual((process.returncode, errors), (0, b""))
            found = {name: content for name, content in digest(self.outputs()).items() if not name.startswith(".csgmesh-")}
            self.assertEqual(found, self.wanted)
            self.assertEqual(self.take(self.wanted, *self.names, options=self.OPTIONS), self.COUNT)


if __name__ == "__main__":
    cli.main()
