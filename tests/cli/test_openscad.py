# SPDX-License-Identifier: MIT
"""csgmesh openscad: each row of the table in scenes/coming-from-openscad.md does what it says."""
import os
import re
import shlex
import struct

import cli

DOCUMENT = os.path.join(cli.SCENES, "coming-from-openscad.md")
OPTIONS = os.path.join(os.path.dirname(__file__), "..", "..", "tools", "csgmesh", "openscad", "openscad_options.def")
PART = """// width
x = 10;
label = "none";
echo(x, label, $t, $preview);
difference() { cube([x, 5, 5 + $t]); sphere(2, $fn = 12); }
"""
SETS = '{"parameterSets": {"large": {"x": "20"}}, "fileFormatVersion": "1"}'


def table():
    """(arguments, what the second cell says) of each row."""
    with open(DOCUMENT, encoding="utf-8") as file:
        text = file.read().split("| `csgmesh openscad` | what it does |\n| --- | --- |\n")[1]
    for line in text.split("\n\n")[0].splitlines():
        first, second = re.match(r"\| `(.*?)` \| (.*) \|$", line).groups()
        yield shlex.split(first), second


def outputs_of(arguments):
    """The files that a command line names as outputs."""
    for option, value in zip(arguments, arguments[1:]):
        if option in ("-o", "-s", "-x", "-d", "--summary-file") and value != "-":
            yield value


class OpenscadTest(cli.CliTest):
    def setUp(self):
        super().setUp()
        self.write("part.scad", PART)
        self.write("flat.scad", "difference() { square([10, 5]); circle(2); }\n")
        self.write("sets.json", SETS)

    def openscad(self, *arguments, status=0, **options):
        result = self.run_in("openscad", *arguments, **options)
        self.assert_clean(result)
        self.assert_status(result, status)
        return result

    def clear(self):
        for name in os.listdir(self.folder):
            if name not in ("part.scad", "flat.scad", "sets.json"):
                os.remove(self.path(name))


class Table(OpenscadTest):
    def check_refused(self, arguments, message):
        result = self.openscad(*arguments, status=2)
        self.assertIn(message, result.stderr)
        self.assertEqual(result.stderr.count("error"), 1, result.stderr)
        self.assert_files("part.scad", "flat.scad", "sets.json")

    def check_done(self, arguments):
        result = self.openscad(*arguments)
        self.assertNotIn("error", result.stderr)
        self.assertNotIn("warning", result.stderr)
        for name in outputs_of(arguments):
            if "--animate" in arguments:
                continue
            self.assertGreater(os.path.getsize(self.path(name)), 0, name)
            self.assertLessEqual(result.stderr.count("ECHO"), 1)

    def test_each_row(self):
        rows = list(table())
        self.assertGreater(len(rows), 50)
        for arguments, says in rows:
            with self.subTest(" ".join(arguments)):
                refused = re.match(r"refused: `(.*?)`", says)
                if refused:
                    self.check_refused(arguments, refused[1])
                else:
                    self.check_done(arguments)
                self.clear()

    def test_each_option_has_a_row(self):
        with open(OPTIONS, encoding="utf-8") as file:
            names = re.findall(r'^OPENSCAD_\w+\(\w+, (\S+), "([^"]+)"', file.read(), re.M)
        words = {word.split("=")[0] for arguments, _ in table() for word in arguments}
        for letter, name in names:
            forms = {("--" if len(name) > 1 else "-") + name, "-" + letter.strip("'")}
            self.assertTrue(forms & words, f"no row has {name}")


class Outputs(OpenscadTest):
    def size_of(self, name):
        data = self.read(name)
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        return struct.unpack(">II", data[16:24])

    def test_stl_is_binary_or_text(self):
        self.openscad("part.scad", "-o", "a.stl", "-q")
        self.assertEqual(len(self.read("a.stl")), 84 + 50 * struct.unpack("<I", self.read("a.stl")[80:84])[0])
        self.openscad("part.scad", "-o", "b.stl", "--export-format", "asciistl", "-q")
        self.assertTrue(self.read("b.stl").startswith(b"solid "))

    def test_values(self):
        for arguments, width in ((["-D", "x=4"], 4), (["-p", "sets.json", "-P", "large"], 20)):
            self.openscad("part.scad", "-o", "a.stl", *arguments)
            self.assertEqual(self.info("a.stl")["mesh"]["bounds"][1][0], width)

    def test_facets_are_those_of_openscad(self):
        self.write("ball.scad", "sphere(1, $fn = 24);")
        self.openscad("ball.scad", "-o", "a.off")
        self.assertLess(abs(self.info("a.off")["mesh"]["volume"] - 4.0567), 0.02)

    def test_pictures(self):
        self.openscad("part.scad", "-o", "a.png")
        self.assertEqual(self.size_of("a.png"), (512, 512))
        self.openscad("part.scad", "-o", "a.png", "--imgsize=64,48")
        self.assertEqual(self.size_of("a.png"), (64, 48))

    def same_pictures(self, openscad, ours):
        self.openscad("part.scad", "-q", "-o", "a.png", "--imgsize=80,60", "--render", *openscad)
        result = self.run_in("render", "-q", "part.scad", "-o", "b.png", "--size", "80x60", "--facets=exact",
                             "--background", "#ffffe5", *ours)
        self.assert_status(result, 0)
        self.assertEqual(self.read("a.png"), self.read("b.png"))

    def test_cameras(self):
        """No rotation looks from above; 90 degrees about x from the front; then about z from the right."""
        wide = ["--fov", "22.5"]
        self.same_pictures(["--camera=1,2,3,0,0,0,90"], [*wide, "--camera", "1,2,93,1,2,3,0,1,0"])
        self.same_pictures(["--camera=7,8,90,7,8,3"], [*wide, "--camera", "7,8,90,7,8,3,0,1,0"])
        self.same_pictures(["--camera=70,8,9,1,2,3"], [*wide, "--camera", "70,8,9,1,2,3"])
        result = self.openscad("part.scad", "-o", "front.png", "--camera=0,0,0,90,0,0,100", "--projection=o", "-q")
        self.assertFalse(result.stderr)
        self.same_pictures(["--camera=0,0,0,0,0,0,100", "--projection=ortho"],
                           ["--projection", "orthographic", "--height", "39.782473475931599", "--camera",
                            "0,0,100,0,0,0,0,1,0"])

    def test_viewall_is_far_enough(self):
        self.openscad("part.scad", "-q", "-o", "a.png", "--camera=0,0,0,55,0,25,1", "--imgsize=40,40")
        near = self.read("a.png")
        self.openscad("part.scad", "-q", "-o", "a.png", "--camera=0,0,0,55,0,25,1", "--imgsize=40,40", "--viewall")
        self.assertNotEqual(self.read("a.png"), near)

    def test_animation(self):
        self.openscad("part.scad", "-o", "a.png", "-o", "a.stl", "--animate", "4", "--imgsize=16,16")
        self.assert_files("part.scad", "flat.scad", "sets.json", *(f"a0000{i}.png" for i in range(4)),
                          *(f"a0000{i}.stl" for i in range(4)))
        heights = [self.info(f"a0000{i}.stl")["mesh"]["bounds"][1][2] for i in range(4)]
        self.assertEqual(heights, [5, 5.25, 5.5, 5.75])

    def test_shards_are_a_whole(self):
        for shard in (1, 2, 3):
            self.openscad("part.scad", "-q", "-o", f"{shard}.csg", "--animate", "7", "--animate_sharding", f"{shard}/3")
        frames = [name[1:6] for name in os.listdir(self.folder) if name.endswith(".csg")]
        self.assertEqual(sorted(frames), [f"{i:05}" for i in range(7)])

    def test_echo(self):
        result = self.openscad("part.scad", "-o", "a.echo", "-D", "x=3")
        self.assertEqual(self.read("a.echo"), b'ECHO: 3, "none", 0, true\n')
        self.assertFalse(result.stderr)
        result = self.openscad("part.scad", "-o", "-", "--export-format=echo", "-q")
        self.assertEqual(result.stdout, b'ECHO: 10, "none", 0, true\n')
        self.write("wrong.scad", "echo(1); assert(false);")
        result = self.openscad("wrong.scad", "-o", "b.echo", status=1)
        self.assertIn(b"assertion", self.read("b.echo"))
        self.assertIn("assertion", result.stderr)

    def test_preview(self):
        for option, value in (("--render", "false"), ("--preview", "true"), ("-q", "")):
            result = self.openscad("part.scad", "-o", "a.png", option, "--imgsize=8,8")
            self.assertIn(value, result.stderr)
        self.assertIn("false", self.openscad("part.scad", "-o", "a.stl").stderr)

    def test_tree(self):
        self.openscad("part.scad", "-q", "-o", "a.csg", "-o", "a.off")
        self.openscad("a.csg", "-q", "-o", "b.off")
        volumes = [self.info(name)["mesh"]["volume"] for name in ("a.off", "b.off")]
        self.assertLess(abs(volumes[0] - volumes[1]), 1e-3 * volumes[0])
        self.openscad("flat.scad", "-q", "-o", "flat.csg", "-o", "flat.svg")
        self.assertNotIn(b"extrude", self.read("flat.csg"))
        self.write("blend.scad", "union(blend = 1) { cube(3); sphere(2); }")
        result = self.openscad("blend.scad", "-o", "c.csg", status=2)
        self.assertIn("E0346", result.stderr)
        self.assertFalse(os.path.exists(self.path("c.csg")))

    def test_rule_for_make(self):
        self.write("lib.scad", "module m() cube(3);")
        self.write("user.scad", "use <lib.scad>\nm();")
        for name in ("a.stl", "a.png", "a.csg", "a.echo"):
            self.openscad("user.scad", "-q", "-o", name, "-d", "a.d")
            text = self.read("a.d").decode()
            self.assertTrue(text.startswith(name + ":"), text)
            self.assertIn("lib.scad", text)

    def test_warnings(self):
        self.write("warns.scad", "cube(missing_size);")
        self.openscad("warns.scad", "-o", "a.stl")
        os.remove(self.path("a.stl"))
        result = self.openscad("warns.scad", "-o", "a.stl", "--hardwarnings", status=1)
        self.assertIn("error", result.stderr)
        self.assertFalse(os.path.exists(self.path("a.stl")))

    def test_summary(self):
        result = self.openscad("part.scad", "-o", "a.stl", "--summary", "bounding-box", "--summary", "area",
                               "--summary-file", "-")
        self.assertIn("Max:  10.00, 5.00, 5.00", result.stderr)
        self.assertIn("Area:", result.stderr)
        self.assertNotIn("Facets", result.stderr)
        self.assertIn(b'"size": [10, 5, 5]', result.stdout)

    def test_inputs_are_no_outputs(self):
        for name in ("part.scad", "./part.scad"):
            for more in ("csg", "echo", "stl", "png"):
                self.openscad("part.scad", "-o", name, "--export-format", more, status=2)
                self.assertEqual(self.read("part.scad").decode(), PART)

    def test_no_file_is_written_twice(self):
        self.write("lib.scad", "module m() cube(3);")
        self.write("user.scad", "use <lib.scad>\nm();")
        for arguments in (["-o", "a.stl", "-o", "./a.stl"], ["-o", "a.stl", "-d", "a.stl"], ["-o", "a.csg", "-d", "user.scad"],
                          ["-o", "a.echo", "-d", "lib.scad"], ["-o", "a.stl", "--summary-file", "user.scad"],
                          ["-o", "a.stl", "--summary-file", "a.stl"]):
            result = self.openscad("user.scad", *arguments, status=2)
            self.assertFalse(os.path.exists(self.path("a.stl")), result.stderr)
            self.assertEqual(self.read("user.scad"), b"use <lib.scad>\nm();")
            self.assertEqual(self.read("lib.scad"), b"module m() cube(3);")

    def test_standard_input(self):
        self.openscad("-", "-o", "a.stl", stdin=b"cube(3);")
        self.assertEqual(self.info("a.stl")["mesh"]["volume"], 27)
        result = self.openscad("-", "-o", "a.stl", "-o", "a.csg", status=2, stdin=b"cube(3);")
        self.assertIn("standard input is read once", result.stderr)

    def test_mistakes(self):
        for arguments, words in (
                (["part.scad", "-o"], "-o needs FILE"),
                (["part.scad", "-o", "a.png", "--camera=1,2,3"], "--camera wants six or seven numbers"),
                (["part.scad", "-o", "a.png", "--camera=1,2,3,4,5,6,x"], "--camera wants six or seven numbers"),
                (["part.scad", "-o", "a.png", "--imgsize=1x2"], "--imgsize wants WIDTH,HEIGHT"),
                (["part.scad", "-o", "a.png", "--animate", "0"], "--animate wants"),
                (["part.scad", "-o", "a.png", "--animate_sharding", "1/2"], "needs --animate"),
                (["part.scad", "-o", "a.png", "--animate=2", "--animate_sharding=3/2"], "wants K/N"),
                (["part.scad", "-o", "a.png", "--colorscheme=Foo"], "--colorscheme wants Cornfield"),
                (["part.scad", "-o", "a.png", "--viewal"], "did you mean '--viewall'"),
                (["part.scad", "-o", "a.png", "--viewall=1"], "takes no value"),
                (["part.scad", "-o", "a.png", "-k"], "unknown option '-k'"),
                (["part.scad", "flat.scad", "-o", "a.stl"], "one scene at a time"),
                (["-o", "a.stl"], "no scene given"),
                (["part.scad", "-o", "a"], "names no format"),
                (["part.scad", "-o", "a.png", "--summary=all"], "--summary needs a file with a mesh"),
                (["part.scad", "-o", "a.svg", "--summary=all"], "--summary needs a file with a mesh"),
                (["part.scad", "-o", "a.stl", "-D", "3"], "-D wants NAME=EXPR"),
                (["part.scad", "-o", "a.stl", "--facets", "coarse"], "--facets wants")):
            result = self.openscad(*arguments, status=2)
            self.assertIn(words, result.stderr)
            self.assertEqual(result.stderr.count("error"), 1, result.stderr)

    def test_help(self):
        for arguments in (["help", "openscad"], ["openscad", "--help"], ["openscad", "-h"]):
            text = self.run_in(*arguments).stdout.decode()
            self.assertIn("--colorscheme NAME", text)
            self.assertLess(max(map(len, text.splitlines())), 100)


if __name__ == "__main__":
    cli.main()
