#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Scenes that mean harm: each ends in a finding, with the limits given and with the defaults, and never
takes the machine with it. Address space is limited, where no sanitizer needs it.
"""
import os
import resource
import subprocess
import sys
import unittest

import cli

SANITIZED = cli.SANITIZED
TIGHT = ["--max-depth", "2000", "--max-nodes", "100000", "--max-memory", "300M", "--timeout", "20"]
DEEP = 100000
HUGE = "function f(v, n) = n == 0 ? v : f([v, v], n - 1); a = f(1, 1000); b = f(1, 1000); "

# name: (scene, code with tight limits, code with the defaults or None = too slow for a test).
# A tuple of codes: any of them.
SCENES = {
    "a billion rounds": ("for (i = [0 : 1e9]) sphere(1);", "E0904", "E0904"),
    "a billion in three": ("for (i = [0 : 1000], j = [0 : 1000], k = [0 : 1000]) if (i < 0) sphere(1);",
                           ("E0904", "E0902"), None),
    "a loop of a list": ("x = [for (i = 0; true; i = i + 1) if (false) i];", "E0904", "E0904"),
    "a range of 1e300": ("for (i = [0 : 1e300]) sphere(1);", "E0904", "E0904"),
    "tiny steps": ("for (i = [0 : 1e-300 : 1]) sphere(1);", "E0904", "E0904"),
    "a list that doubles": ("function f(v) = f(concat(v, v)); x = f([1]);", ("E0906", "E0901"), "E0906"),
    "a list of lists of itself": ("function f(v) = f([v]); x = f(1);", "E0903", "E0903"),
    "a string that doubles": ("function f(s) = f(str(s, s)); x = f(\"ab\");", "E0907", "E0907"),
    "a value of 2^1000 numbers as text": (HUGE + "echo(a);", ("E0907", "E0902"), ("E0907", "E0904")),
    "compared": (HUGE + "x = a == b;", ("E0904", "E0902"), None),
    "multiplied": (HUGE + "x = a * 2;", ("E0901", "E0904", "E0902"), None),
    "in an assertion": (HUGE + "assert(false, a);", "E0208", None),
    "functions in turn": ("function a(n) = 1 + b(n); function b(n) = 1 + a(n); x = a(1);", "E0903", "E0903"),
    "modules in turn": ("module a() b(); module b() a(); a();", "E0903", "E0903"),
    "a function of itself": ("y = function (f) 1 + f(f); x = y(y);", "E0903", "E0903"),
    "modules that branch": ("module a(n) if (n > 0) { a(n - 1); a(n - 1); } a(60);", "E0905", None),
    "children that branch": ("module m() { children(); children(); } " + "m() " * 40 + "sphere(1);",
                             "E0905", "E0905"),
    "many random numbers": ("x = rands(0, 1, 1e9);", "E0906", "E0906"),
    "a search in a search": ("a = [for (i = [0 : 1000000]) i]; x = search(a, a);",
                             ("E0904", "E0902"), "E0904"),
    "characters by number": ("x = chr([1 : 1e9]);", "E0904", "E0904"),
    "a long literal": ('x = "' + "a" * 3000000 + '"; for (i = [0 : 1e6], j = [0 : 1e6]) if (len("'
                       + "b" * 3000000 + '") < 0) sphere(1);', ("E0904", "E0902"), None),
    "many parameters": ("function f(" + ", ".join(f"p{i}" for i in range(900)) + ") = f(0); x = f(0);",
                        ("E0904", "E0902"), None),
    "zero": ("torus(0);", "E0302", "E0302"),
    "no number": ("sphere(0 / 0);", "E0302", "E0302"),
    "infinite": ("cylinder(h = 1 / 0, r = 1);", "E0302", "E0302"),
    "below zero": ("torus(-1, 2);", "E0302", "E0302"),
    "huge": ("sphere(1e308);", "E0308", "E0308"),
    "tiny": ("sphere(5e-324);", "E0308", "E0308"),
    "a NUL byte": ("sphere(1);\0", "E0102", "E0102"),
    "only NUL bytes": ("\0" * 100000, "E0112", "E0112"),
    "a million mistakes": ("x = ;\n" * 1000000, "E0108", "E0108"),
    "a million braces": ("} " * 1000000, "E0110", "E0110"),
    "open brackets": ("x = " + "[" * 1000000, "E0903", "E0903"),
    "an include of itself": ("include <scene.txt>\n", "E0123", "E0123"),
    "an include of a device": ("include </dev/zero>\n", "E0121", "E0121"),
    "an include of a folder": ("include </>\n", ("E0121", "E0122"), ("E0121", "E0122")),
    "an include of a pipe": ("include <pipe>\n", "E0121", "E0121"),
    "a formula that branches": (
        "function g(p, n) = n == 0 ? p.x : g(p, n - 1) * g(p, n - 1); "
        "field(function (p) g(p, 40), bounds = [[-1, -1, -1], [1, 1, 1]]);", ("E0904", "E0902", "E0910"), None),
}

# before, opening, middle, closing: nested 100 000 times
NESTED = [("x = ", "(", "1", ")"), ("x = ", "[", "1", "]"), ("", "{", "sphere(1);", "}"),
          ("", "module m() {", "", "}"), ("x = ", "-", "1", ""), ("x = ", "!", "1", ""),
          ("x = ", "1 ? ", "1", " : 2"), ("x = ", "0 ? 1 : ", "1", ""), ("", "union() ", "sphere(1);", ""),
          ("", "if (true) ", "sphere(1);", ""), ("", "for (i = 1) ", "sphere(1);", ""),
          ("x = ", "let (a = 1) ", "a", ""), ("x = ", "function (a) ", "1", ""), ("x = ", "len(", "1", ")"),
          ("x = ", "[1][", "0", "]"), ("x = ", "2 ^ ", "1", ""), ("x = ", "assert(true) ", "1", ""),
          ("x = [", "each ", "1", ""), ("x = [", "for (i = 0; i < 1; i = i + 1) ", "1", "")]


def limit_address_space():
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))


class Harm(cli.CliTest):
    def check(self, scene, codes, options):
        path = self.write("scene.txt", scene)
        result = subprocess.run([cli.PROGRAM, "check", *options, path], cwd=self.folder, timeout=300,
                                stdin=subprocess.DEVNULL, capture_output=True, check=False,
                                preexec_fn=None if SANITIZED else limit_address_space)
        errors = result.stderr.decode("utf-8", "replace")
        self.assertIn(result.returncode, (1, 2), errors[:1000])
        codes = codes if isinstance(codes, tuple) else (codes,)
        self.assertTrue(any(code in errors for code in codes), errors[:1000])
        self.assertLess(len(errors), 100000)

    def test_scenes(self):
        os.mkfifo(self.path("pipe"))
        for name, (scene, tight, default) in SCENES.items():
            for options, codes in ((TIGHT, tight), ([], default)):
                if codes and not (SANITIZED and not options):
                    with self.subTest(name, options=options):
                        self.check(scene, codes, options)

    def test_nesting(self):
        for before, opening, middle, closing in NESTED:
            scene = before + opening * DEEP + middle + closing * DEEP + "; sphere(1);"
            for options in (TIGHT,) if SANITIZED else (TIGHT, []):
                with self.subTest(opening, options=options):
                    self.check(scene, "E0903", options)

    @unittest.skipIf(SANITIZED, "takes minutes there")
    def test_creases_in_little_memory(self):
        """What is known of 93 000 vertices on creases has room beside the blocks: 237 MB of mesh under 44 MiB."""
        self.write("lattice.txt", "intersection() { cube([40, 40, 40]); gyroid(cell = 4, thickness = 0.6); }")
        self.assert_status(cli.run("lattice.txt", "-r", "256", "-q", "--max-memory", "44M", "--threads", "2", "-o", "a.ply",
                                   cwd=self.folder), 0)

    def test_creases_in_slabs(self):
        """Meshed in slabs, with features found in one pass and emitted in another, it has the bytes of one that is in memory."""
        self.write("lattice.txt", "intersection() { cube([10, 10, 10]); gyroid(cell = 4, thickness = 0.6); }")
        size = ("-r", "48") if SANITIZED else ("-r", "128")
        for name, limit in (("wide.ply", "2G"), ("tight.ply", "12M" if SANITIZED else "13M")):
            self.assert_status(cli.run("lattice.txt", *size, "-q", "--max-memory", limit, "--threads", "2", "-o", name,
                                       cwd=self.folder), 0)
        self.assertTrue(self.read("wide.ply") == self.read("tight.ply"))

    def test_large_files(self):
        with open(self.path("large.txt"), "wb") as file:
            file.truncate(1 << 30)
        result = cli.run("check", "large.txt", cwd=self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("E0908", result.stderr)
        for device in ("/dev/zero", "/dev/urandom"):
            if os.path.exists(device):
                result = cli.run("check", device)
                self.assertEqual(result.returncode, 2, device)
                self.assertIn("E0908", result.stderr)

    def test_pipe(self):
        result = cli.run("check", "/dev/stdin", stdin=b"sphere(1);")
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_includes_that_branch(self):
        """A tree of 2^40 files that are only two."""
        for i in range(40):
            self.write(f"part{i}.txt", f"include <part{i + 1}.txt>\n" * 2)
        self.write("part40.txt", "x = 1;\n")
        result = cli.run("check", "part0.txt", cwd=self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("E0909", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
