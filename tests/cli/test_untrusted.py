# SPDX-License-Identifier: MIT
"""--root: whatever a scene or a command line names, nothing outside is read or written. Over 100 escapes."""
import os
import platform
import shutil
import subprocess
import unittest

import cli

# LeakSanitizer reads /proc at the end, which no root lets through.
os.environ["ASAN_OPTIONS"] = os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"

SECRET = "a_secret_word_4711"
TRIANGLE = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
GLTF = ('{"asset":{"version":"2.0"},"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"uri":"%s",'
        '"byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,'
        '"count":3,"type":"VEC3"}],"nodes":[{"mesh":0}]}')


class Untrusted(cli.CliTest):
    def setUp(self):
        super().setUp()
        for folder in ("in", "in/below", "out"):
            os.mkdir(self.path(folder))
        self.write("out/s.txt", f"echo(\"{SECRET}\"); module ball() sphere(1); cube(1); /* {SECRET} */\n")
        self.write("out/a.stl", TRIANGLE)
        self.write("out/t.svg", '<svg xmlns="http://www.w3.org/2000/svg"><rect width="3" height="3"/></svg>')
        self.write("out/t.csv", "1 2 3\n4 5 6\n7 8 9\n")
        self.write("out/t.json", f'{{"parameterSets": {{"{SECRET}": {{"x": "1"}}}}}}')
        self.write("out/a.bin", b"\0" * 36)
        self.write("in/ok.txt", "cube(1);\n")
        self.write("in/below/part.txt", "module ball() sphere(1);\n")
        os.symlink("../out", self.path("in/door"))
        for name in ("s.txt", "a.stl", "t.svg", "t.csv", "t.json", "a.bin"):
            os.symlink("../out/" + name, self.path("in/link-" + name))
        if "Landlock" in self.rooted("check", "ok.txt").stderr:
            self.skipTest("this kernel has no Landlock")

    def rooted(self, *arguments, **options):
        return cli.run(*arguments, "--root", self.path("in"), cwd=self.path("in"), **options)

    def ways_to(self, name):
        """Names of a file of out/, as seen from in/."""
        out = self.path("out")
        return [f"{out}/{name}", f"../out/{name}", f"./below/../../out/{name}", f"door/{name}", f"link-{name}",
                f"/proc/self/cwd/../out/{name}", f"/proc/self/root{out}/{name}"]

    def outside(self):
        found = {}
        for name in sorted(os.listdir(self.path("out"))):
            with open(self.path("out/" + name), "rb") as file:
                found[name] = file.read()
        return found, sorted(os.listdir(self.folder))

    def inside(self):
        text = b""
        for folder, _, names in os.walk(self.path("in")):
            for name in names:
                path = os.path.join(folder, name)
                if not os.path.islink(path) and name != "evil.txt" and not name.startswith("evil"):
                    with open(path, "rb") as file:
                        text += file.read()
        return text

    def escapes(self):
        """What to run, with the text of in/evil.txt or in/evil.gltf."""
        for path in self.ways_to("s.txt"):
            yield f"include <{path}>\n", ["evil.txt", "-o", "r.stl"]
            yield f"use <{path}>\nball();\n", ["evil.txt", "-o", "r.stl"]
            yield None, [path, "-o", "r.stl"]
            yield None, ["check", path]
            yield None, ["render", path, "-o", "r.ppm", "--size", "8x8"]
            yield None, ["dump", "--scene", path]
        for name in ("a.stl", "t.svg", "t.json"):
            for path in self.ways_to(name):
                yield f"import(\"{path}\");\n", ["evil.txt", "-o", "r.stl"]
        for path in self.ways_to("t.csv"):
            yield f"surface(\"{path}\");\n", ["evil.txt", "-o", "r.stl"]
        for path in self.ways_to("a.stl"):
            yield None, ["info", path]
            yield None, ["diff", "ok.txt", path]
            yield None, ["render", path, "-o", "r.ppm", "--size", "8x8"]
        for path in self.ways_to("t.json"):
            yield None, ["ok.txt", "-p", path, "-P", SECRET, "-o", "r.stl"]
        for path in self.ways_to("a.bin") + ["%2e%2e/out/a.bin", "..%2fout%2Fa.bin", "file:///etc/passwd"]:
            yield GLTF % path, ["info", "evil.gltf"]
        for path in [way for way in self.ways_to("new.stl") if way != "link-new.stl"] + self.ways_to("a.stl"):
            yield None, ["ok.txt", "-r", "8", "-o", path]
            yield None, ["ok.txt", "-r", "8", "-o", "r.stl", "--stats=" + path]
            yield None, ["ok.txt", "-r", "8", "-o", "r.stl", "-M", path]
            yield None, ["ok.txt", "-r", "8", "-o", "r.stl", "--trace", path]
            yield None, ["diff", "ok.txt", "ok.txt", "-r", "8", "--json", path]
        for folder in ("../out", self.path("out"), "door", "../new"):
            yield None, ["batch", "ok.txt", "-r", "8", "-d", folder, "-f", "stl"]

    def test_escapes(self):
        before, count = self.outside(), 0
        for text, arguments in self.escapes():
            if text:
                self.write("in/evil.gltf" if "evil.gltf" in arguments else "in/evil.txt", text)
            result = self.rooted(*arguments)
            self.assertNotEqual(result.returncode, 0, arguments)
            self.assertGreaterEqual(result.returncode, 0, arguments)
            self.assertNotIn(SECRET, result.stdout.decode() + result.stderr.replace(f"'{SECRET}'", ""), arguments)
            self.assertEqual(self.outside(), before, arguments)
            count += 1
        self.assertGreaterEqual(count, 100)
        self.assertNotIn(SECRET.encode(), self.inside())

    def test_what_is_inside_works(self):
        self.write("in/good.txt", "use <below/part.txt>\nball(); translate([2, 0, 0]) import(\"a.stl\");\n")
        cli.run("ok.txt", "-r", "8", "-o", "a.stl", cwd=self.path("in"))
        file = "below/r.glb" if cli.has_library("tinygltf") else "below/r.ply"
        self.assert_status(self.rooted("good.txt", "-r", "16", "-o", file, "--stats=s.json"), 0)
        self.assert_status(self.rooted("diff", file, "good.txt", "-r", "16", "--json", "d.json"), 0)
        self.assert_status(self.rooted("info", self.path("in/" + file)), 0)
        self.assert_status(self.rooted("-", "-r", "8", "-f", "stl", "-o", "-", stdin=b"cube(1);"), 0)

    def test_roots_from_the_environment(self):
        result = cli.run("check", self.path("out/s.txt"), env={"CSGMESH_ROOT": self.path("in")})
        self.assertNotEqual(result.returncode, 0)
        both = self.path("in") + ":" + self.path("out")
        self.assert_status(cli.run("check", self.path("out/s.txt"), env={"CSGMESH_ROOT": both}), 0)
        self.assert_status(cli.run("check", "s.txt", "--root", ".", cwd=self.path("out")), 0)

    def test_a_root_that_is_none(self):
        result = cli.run("check", "ok.txt", "--root", "none", cwd=self.path("in"))
        self.assert_status(result, 2)
        self.assertIn("--root none: No such file or directory", result.stderr)


# Stands before the C library's open(): when the scene is opened it tries what a sandbox forbids, and says how each went.
PROBE = r"""
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>
#define TELL(what, call) do { errno = 0; long r = (long)(call); fprintf(stderr, "probe %s %s\n", what, r != -1 ? "done" : errno == EPERM ? "refused" : strerror(errno)); } while (0)
static void try_all(void)
{
    static int tried;
    char *none[] = {"true", NULL}, ring[256] = {0}; /* more than the kernel writes there */
    if (tried++)
        return;
    TELL("internet", socket(AF_INET, SOCK_STREAM, 0));
    TELL("internet6", socket(AF_INET6, SOCK_DGRAM, 0));
    TELL("local", socket(AF_UNIX, SOCK_STREAM, 0));
    TELL("netlink", socket(AF_NETLINK, SOCK_RAW, 0));
    TELL("pair", socketpair(AF_UNIX, SOCK_STREAM, 0, (int[2]){0}));
    TELL("ring", syscall(425, 1, ring));
    TELL("exec", execve("/no/such/program", none, NULL));
    TELL("execat", syscall(SYS_execveat, AT_FDCWD, "/no/such/program", none, NULL, 0));
    TELL("signal", kill(getppid(), 0));
    TELL("trace", ptrace(PTRACE_ATTACH, 0x7fffffff, 0, 0));
    TELL("namespace", syscall(SYS_unshare, 0));
    TELL("own-signal", kill(getpid(), 0));
}
int open(const char *path, int flags, ...)
{
    va_list list;
    va_start(list, flags);
    int mode = va_arg(list, int);
    va_end(list);
    if (strstr(path, "probed"))
        try_all();
    return (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
}
int open64(const char *path, int flags, ...) __attribute__((alias("open")));
"""


@unittest.skipUnless(platform.system() == "Linux" and platform.machine() in ("x86_64", "aarch64", "riscv64"),
                     "--sandbox is for Linux on some processors")
class Sandbox(cli.CliTest):
    def probe(self, *arguments, **environment):
        """What the probe in the process could do: its words by their names."""
        if os.environ.get("CSGMESH_SANITIZED") == "1" or not shutil.which("cc"):
            self.skipTest("needs a compiler, and a build without sanitizers")
        self.write("probe.c", PROBE)
        subprocess.run(["cc", "-shared", "-fPIC", "-w", "-o", self.path("probe.so"), self.path("probe.c")], check=True)
        self.write("probed.txt", "sphere(1);\n")
        result = cli.run("check", "probed.txt", *arguments, cwd=self.folder,
                         env={"LD_PRELOAD": self.path("probe.so"), **environment})
        self.assert_status(result, 0)
        return dict(line.split(" ", 2)[1:] for line in result.stderr.splitlines() if line.startswith("probe "))

    def test_nothing_gets_out(self):
        free = self.probe()
        if not free:
            self.skipTest("this program cannot be probed: it is linked without shared libraries")
        self.assertEqual(len(free), 12)
        self.assertEqual([free["local"], free["exec"], free["signal"]], ["done", "No such file or directory", "done"])
        for kept in (self.probe("--sandbox"), self.probe(CSGMESH_SANDBOX="1")):
            self.assertEqual(kept.pop("own-signal"), "done")
            self.assertEqual(set(kept.values()), {"refused"}, kept)

    def test_work_goes_on(self):
        self.write("a.txt", "union(blend = 1) { cube(5); sphere(3); }\n")
        with open(self.path("free.stl"), "wb") as file:
            file.write(cli.run("a.txt", "-f", "stl", "-o", "-", cwd=self.folder).stdout)
        for arguments in (["a.txt", "-o", "a.stl", "--stats=s.json"], ["a.txt", "-o", "-", "-f", "stl"],
                          ["diff", "a.stl", "a.txt", "--html", "d.html"], ["render", "a.txt", "-o", "a.ppm", "--size", "32x32"],
                          ["batch", "a.txt", "-d", "out", "-f", "ply"], ["info", "a.stl"]):
            with self.subTest(arguments):
                self.assert_status(cli.run(*arguments, "--sandbox", "--threads", "2", cwd=self.folder), 0)
        with open(self.path("a.stl"), "rb") as one, open(self.path("free.stl"), "rb") as other:
            self.assertEqual(one.read(), other.read())


@unittest.skipIf(platform.system() != "Linux" or os.environ.get("CSGMESH_SANITIZED") == "1",
                 "the system counts other memory, or sanitizers have their own")
class Fence(cli.CliTest):
    """--max-memory holds for what libraries take, too."""

    def test_draco(self):
        if not cli.has_library("Draco"):
            self.skipTest("no Draco")
        self.write("a.txt", "sphere(10);\n")
        self.assert_status(cli.run("a.txt", "-r", "400", "-q", "-o", "a.drc", cwd=self.folder), 0)
        self.assert_status(cli.run("info", "a.drc", "--max-memory", "500M", cwd=self.folder), 0)
        result = cli.run("info", "a.drc", "--max-memory", "8M", "--threads", "1", cwd=self.folder)
        self.assert_status(result, 2)
        self.assertIn("E0901", result.stderr)
        self.assertIn("more memory is needed than the limit of 8 MiB", result.stderr)


if __name__ == "__main__":
    cli.main()
