# SPDX-License-Identifier: MIT
"""How findings reach people and editors: places, traces, sums, JSON lines, -Werror, colour."""
import json
import os

import cli

NESTED = {"a.txt": "use <b.txt>\nouter(1);\n", "b.txt": "include <c.txt>\nmodule outer(x) inner(x);\n",
          "c.txt": "module inner(x) { torus(-x); }\n"}


class Text(cli.CliTest):
    def test_include_and_call_trace(self):
        for name, text in NESTED.items():
            self.write(name, text)
        result = self.run_in("check", "a.txt")
        self.assert_status(result, 1)
        lines = result.stderr.splitlines()
        self.assertRegex(lines[0], r"^c\.txt:1:\d+: error E0302: ")
        places = [line.split(" note: ") for line in lines if " note: " in line]
        self.assertEqual([what for _, what in places],
                         ["included from here", "used from here", "in the call of module 'inner'",
                          "in the call of module 'outer'"])
        self.assertTrue(places[0][0].startswith("b.txt:1:"))
        self.assertTrue(places[1][0].startswith("a.txt:1:"))

    def test_recursion_is_folded(self):
        self.write("a.txt", "function f(n) = 1 + f(n + 1);\nx = f(0);\nsphere(x);\n")
        result = self.run_in("check", "a.txt")
        self.assert_refused_briefly(result)
        self.assertIn("and 9998 more like this", result.stderr)
        self.write("b.txt", "module a(n) b(n);\nmodule b(n) a(n + 1);\na(0);\n")
        result = self.run_in("check", "b.txt")
        self.assert_refused_briefly(result)
        self.assertIn("more calls like these", result.stderr)

    def assert_refused_briefly(self, result):
        self.assert_clean(result)
        self.assert_status(result, 2)
        self.assertLess(len(result.stderr.splitlines()), 20, result.stderr)

    def test_warnings_alike_are_summed_up(self):
        self.write("a.txt", "".join(f"a{i} = b{i};\n" for i in range(30)) + "sphere(1);\n")
        result = self.run_in("check", "a.txt")
        self.assert_status(result, 0)
        self.assertEqual(result.stderr.count("warning W0203"), 5)
        self.assertTrue(result.stderr.endswith("note: and 25 more like W0203 in a.txt: no variable has this name\n"))

    def test_an_error_behind_many_warnings_is_shown(self):
        self.write("a.txt", "".join(f"a{i} = b{i};\n" for i in range(50)) + "cube(nobody(1));\n")
        result = self.run_in("check", "a.txt")
        self.assert_status(result, 1)
        self.assertIn("error E0202", result.stderr)

    def test_parts_that_are_missing_are_told_behind_many_warnings(self):
        self.write("a.txt", "".join(f"a{i} = b{i};\n" for i in range(50)) +
                   "rotate([70, 0, 315]) cube([10, 10, 0.01]); cube(2);\n")
        result = self.run_in("a.txt", "-r", "128", "-o", "a.stl")
        self.assertIn("warning W0406", result.stderr)

    def test_warnings_inside_libraries_are_one_line(self):
        os.mkdir(os.path.join(self.folder, "libraries"))
        self.write("libraries/rods.txt", "module rod() { cube(nobody); } a = b; c = d;\n")
        self.write("a.txt", "use <rods.txt>\nrod(); cube(other);\n")
        result = self.run_in("check", "-I", "libraries", "a.txt")
        self.assertEqual(result.stderr.count("warning W"), 1)
        self.assertIn("3 warnings inside libraries are not shown (rods.txt 3); -Wlibraries shows them", result.stderr)
        result = self.run_in("check", "-I", "libraries", "-Wlibraries", "a.txt")
        self.assertEqual(result.stderr.count("warning W"), 4)
        self.assertNotIn("not shown", result.stderr)

    def test_what_was_mended_is_told_of_libraries_too(self):
        """A sheet becomes a block: nobody may miss that because a library's module has made the polyhedron."""
        os.mkdir(os.path.join(self.folder, "libraries"))
        self.write("libraries/sheets.txt", "module sheet(points) polyhedron(points, [[0, 1, 2], [0, 2, 3], [0, 3, 1]]); a = b;\n")
        self.write("a.txt", "use <sheets.txt>\nsheet([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]);\n")
        result = self.run_in("check", "-I", "libraries", "a.txt")
        self.assert_status(result, 0)
        self.assertIn("sheets.txt:1:22: warning W0324: polyhedron(): the surface was mended: 1 hole filled", result.stderr)
        self.assertIn("a.txt:2:1: note: in the call of module 'sheet'", result.stderr)
        self.assertIn("1 warning inside libraries is not shown", result.stderr)

    def test_what_encloses_nothing_is_told_of_libraries_too(self):
        """Triangles that are left out are missed; no triangles at all are a library's way to say "nothing"."""
        os.mkdir(os.path.join(self.folder, "libraries"))
        self.write("libraries/sheets.txt", "module sheet(points, faces) polyhedron(points, faces);\n")
        self.write("a.txt", "use <sheets.txt>\nsheet([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [2, 1, 0]]);\nsheet([], []); cube(1);\n")
        result = self.run_in("check", "-I", "libraries", "a.txt")
        self.assert_status(result, 0)
        self.assertIn("sheets.txt:1:29: warning W0338: the triangles of polyhedron() enclose nothing: it is left out", result.stderr)
        self.assertNotIn("W0324", result.stderr)
        self.assertNotIn("W0325", result.stderr)
        self.assertIn("1 warning inside libraries is not shown", result.stderr)

    def test_werror(self):
        self.write("a.txt", "sphere(r = 1, d = 2);\n")
        self.assert_status(self.run_in("check", "a.txt"), 0)
        for arguments in (["check", "-Werror", "a.txt"], ["-W", "error", "check", "a.txt"],
                          ["a.txt", "-Werror", "-o", "a.ply"], ["params", "-Werror", "-D", "zz=1",
                                                                "a.txt"]):
            result = self.run_in(*arguments)
            self.assert_status(result, 1)
            self.assertIn("error E0", result.stderr)
        self.assert_files("a.txt")

    def test_leniency(self):
        text = "nobody(); cube(1);\n"
        self.write("a.scad", text)
        self.write("a.txt", text)
        for arguments, status in ((["a.scad"], 0), (["a.txt"], 1), (["--strict", "a.scad"], 1),
                                  (["--lenient", "a.txt"], 0), (["-Werror", "a.scad"], 1),
                                  (["--strict", "--lenient", "a.txt"], 2)):
            self.assert_status(self.run_in("check", *arguments), status)
        result = self.run_in("check", "-q", "--summary", "a.scad")
        self.assertEqual(result.stderr, "summary: 0 errors, 1 warning; 1 of what OpenSCAD only warns of (0201: 1): "
                                        "--strict makes them errors\n")
        result = self.run_in("check", "--summary", "--diagnostics=json", "a.scad")
        self.assertEqual(json.loads(result.stderr.splitlines()[-1]),
                         {"summary": {"errors": 0, "warnings": 1, "lenient": 1}})

    def test_color(self):
        self.write("a.txt", "sphere(;\n")
        for arguments, env, wanted in (([], {}, False), (["--color=always"], {}, True),
                                       (["--color=always"], {"NO_COLOR": "1"}, True),
                                       (["--color=never"], {}, False), ([], {"NO_COLOR": "1"}, False)):
            result = self.run_in("check", "a.txt", *arguments, env=env)
            self.assertEqual("\033[" in result.stderr, wanted)

    def test_place_of_a_define(self):
        self.write("a.txt", "x = 1;\nsphere(x);\n")
        result = self.run_in("check", "a.txt", "-D", "x=[1,")
        self.assert_status(result, 1)
        self.assertIn("-D x:1:4: error", result.stderr)


class Json(cli.CliTest):
    def findings(self, *arguments, status):
        result = self.run_in(*arguments, "--diagnostics=json")
        self.assert_status(result, status)
        return [json.loads(line) for line in result.stderr.splitlines()]

    def test_a_finding(self):
        self.write("a.txt", 'echo("one");\nsphere(1);\n  shpere(2);\n')
        echo, finding = self.findings("check", "a.txt", status=1)
        self.assertEqual(echo, {"echo": 'ECHO: "one"'})
        self.assertEqual(finding, {"severity": "error", "code": "E0201", "file": "a.txt", "line": 3,
                                   "column": 3, "end_line": 3, "end_column": 9,
                                   "message": "there is no module 'shpere'",
                                   "hint": "did you mean 'sphere'?"})

    def test_notes_stand_inside(self):
        self.write("a.txt", "a = 1;\na = 2;\nmodule m() torus(-a);\nm();\nm();\nb = 1;\nb = 2;\n")
        found = self.findings("check", "a.txt", status=1)
        self.assertEqual([f["severity"] for f in found], ["warning", "warning", "error"])
        self.assertEqual([[n["message"] for n in f.get("notes", [])] for f in found],
                         [["the earlier assignment"], ["the earlier assignment"],
                          ["in the call of module 'm'"]])
        self.assertEqual(found[2]["notes"][0]["line"], 4)
        self.assertEqual(found[2]["notes"][0]["file"], "a.txt")

    def test_what_is_not_about_text(self):
        found = self.findings("check", "missing.txt", status=2)
        self.assertEqual(len(found), 1)
        self.assertEqual((found[0]["severity"], found[0]["file"]), ("error", "missing.txt"))
        self.assertNotIn("line", found[0])
        usage = self.findings("mesh", status=2)
        self.assertEqual(usage[0]["severity"], "error")
        self.assertIn("hint", usage[0])

    def test_the_rest_is_counted(self):
        self.write("a.txt", "".join(f"a{i} = b{i};\n" for i in range(30)) + "sphere(1);\n")
        found = self.findings("check", "a.txt", status=0)
        self.assertEqual(len(found), 6)
        self.assertEqual(found[5]["severity"], "note")
        self.assertIn("and 25 more like W0203", found[5]["message"])

    def test_bytes_that_are_no_text(self):
        self.write("a.txt", b"sphere(1); // \xff\xfe\n\x01\n")
        for finding in self.findings("check", "a.txt", status=1):
            self.assertIn(finding["severity"], ("error", "warning"))

    def test_findings_over_lines(self):
        self.write("a.txt", 's = "one\ntwo;\nsphere(1);\n')
        found = self.findings("check", "a.txt", status=1)
        self.assertTrue(all(f["end_line"] >= f["line"] for f in found))
        self.assertTrue(all((f["end_line"], f["end_column"]) > (f["line"], f["column"])
                            for f in found))

    def test_check_makes_only_what_findings_depend_on(self):
        """A hull of nothing whose boxes meet: only making it shows that it is nothing."""
        nothing = "hull() intersection() { sphere(1); translate([1.3, 1.3, 1.3]) sphere(1); }\n"
        around = {"": False, "translate([1, 0, 0]) difference() { union() children(); cube(1); } ": False,
                  "minkowski() { cube(1); children(); } ": False, "resize([3, 0, 0]) children(); ": True,
                  "projection() children(); ": True, "blend(fillet(1)) children(); ": True}
        for text, is_made in around.items():
            self.write("a.txt", f"module a() {{ {text or 'children();'} }}\na() {nothing}")
            for words, told in (((), is_made), (("--solids",), True)):
                codes = [f["code"] for f in self.findings("check", *words, "a.txt", status=0)]
                self.assertEqual("W0390" in codes, told, (words, text))
        self.write("b.txt", nothing + "union(blend = fillet(1)) { cube(3); translate([8, 0, 0]) cube(1); }\n")
        self.assertEqual(self.findings("check", "b.txt", status=0), self.findings("check", "--solids", "b.txt", status=0))

    def test_quiet(self):
        self.write("a.txt", "a = 1;\na = 2;\ntorus(-a);\necho(1);\n")
        found = self.findings("check", "-q", "a.txt", status=1)
        self.assertEqual([f["code"] for f in found], ["E0302"])


if __name__ == "__main__":
    cli.main()
