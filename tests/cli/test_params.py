# SPDX-License-Identifier: MIT
"""Parameters: what csgmesh params lists, sets of a JSON file, what wins over what, dependencies."""
import json

import cli

SCENE = """// Outer radius
radius = 10; // [5:0.5:50]
/* [Look] */
label = "top"; // [top:Upper side, bottom]
size = [1, 2.5, -3]; // [-5:5]
round = false;
count = 3; // [1:one, 3:three]
/* [Hidden] */
slack = 0.1;
double = 2 * radius;
module part() { sphere(radius); }
late = 4;
echo(radius, label, size, round, count, slack, double, late);
part();
"""
SETS = {"parameterSets": {
    "small": {"radius": "6", "label": "say \"hi\"", "size": "[1, 2, 3]", "round": "true"},
    "native": {"radius": 7.5, "round": True, "size": [4, 5, 6], "label": 12},
    "odd": {"radius": "wide", "double": "3", "nothing": "1", "round": "maybe", "raduis": 3,
            "size": {"x": 1}, "count": None, "late": "9"}},
    "fileFormatVersion": "1"}


class ParamsTest(cli.CliTest):
    def setUp(self):
        super().setUp()
        if "with nlohmann-json" not in cli.run("--version").stdout.decode():
            self.skipTest("built without nlohmann-json")
        self.write("a.txt", SCENE)
        self.write("sets.json", json.dumps(SETS))

    def echo(self, *arguments):
        result = self.run_in("check", "a.txt", *arguments)
        self.assert_status(result, 0)
        return [line for line in result.stderr.splitlines() if line.startswith("ECHO: ")][0][6:]

    def params(self, *arguments):
        result = self.run_in("params", *arguments)
        self.assert_status(result, 0)
        return json.loads(result.stdout)


class Listing(ParamsTest):
    def test_all_that_the_comments_say(self):
        listed = self.params("a.txt")
        self.assertEqual((listed["title"], listed["fileFormatVersion"]), ("a", "1"))
        self.assertEqual(listed["parameters"], [
            {"name": "radius", "type": "number", "group": "Parameters", "caption": "Outer radius",
             "initial": 10, "min": 5, "max": 50, "step": 0.5, "line": 2},
            {"name": "label", "type": "string", "group": "Look", "initial": "top",
             "options": [{"name": "Upper side", "value": "top"},
                         {"name": "bottom", "value": "bottom"}], "line": 4},
            {"name": "size", "type": "number", "group": "Look", "initial": [1, 2.5, -3], "min": -5,
             "max": 5, "line": 5},
            {"name": "round", "type": "boolean", "group": "Look", "initial": False, "line": 6},
            {"name": "count", "type": "number", "group": "Look", "initial": 3,
             "options": [{"name": "one", "value": 1}, {"name": "three", "value": 3}], "line": 7}])

    def test_values_that_were_set(self):
        listed = self.params("a.txt", "-p", "sets.json", "-P", "small", "-D", "count=radius/2",
                             "-D", "radius=8")
        values = {p["name"]: p.get("value") for p in listed["parameters"]}
        self.assertEqual(values, {"radius": 8, "label": 'say "hi"', "size": [1, 2, 3],
                                  "round": True, "count": 4})

    def test_nothing_is_evaluated_without_need(self):
        self.write("b.txt", "a = 1;\nassert(false);\nfor (i = [1 : 1e9]) cube(i);\n")
        self.assertEqual([p["name"] for p in self.params("b.txt")["parameters"]], ["a"])

    def test_standard_input_and_faults(self):
        result = cli.run("params", "-", stdin=b"x = 3; // [1:5]\n")
        self.assertEqual(json.loads(result.stdout)["parameters"][0]["max"], 5)
        self.write("b.txt", "x = ;\n")
        self.assert_refused(self.run_in("params", "b.txt"), 1, "b.txt:1:5")
        self.assert_refused(self.run_in("params"), 2, "no scene given")
        result = self.run_in("params", "a.txt", "-D", "radius=undef")
        self.assertIn("W0243", result.stderr)
        self.assertEqual(result.returncode, 0)


class Sets(ParamsTest):
    def test_each_wins_over_the_one_before(self):
        self.assertEqual(self.echo(), '10, "top", [1, 2.5, -3], false, 3, 0.1, 20, 4')
        self.assertEqual(self.echo("-p", "sets.json", "-P", "small"),
                         '6, "say "hi"", [1, 2, 3], true, 3, 0.1, 12, 4')
        self.assertEqual(self.echo("-D", "radius=20", "-p", "sets.json", "-P", "small"),
                         '20, "say "hi"", [1, 2, 3], true, 3, 0.1, 40, 4')

    def test_values_of_json_itself(self):
        self.assertEqual(self.echo("-p", "sets.json", "-P", "native"),
                         '7.5, "12", [4, 5, 6], true, 3, 0.1, 15, 4')

    def test_what_does_not_fit_is_told_and_left_out(self):
        result = self.run_in("check", "a.txt", "-p", "sets.json", "-P", "odd")
        self.assert_status(result, 0)
        self.assertIn('ECHO: 10, "top", [1, 2.5, -3], false, 3, 0.1, 20, 9', result.stderr)
        for words in ("'radius' of the parameter set 'odd' is ignored: the scene wants a number",
                      "'double' of the parameter set 'odd' is ignored: the scene computes",
                      "no variable 'nothing'", "the scene wants true or false, not 'maybe'",
                      "did you mean 'radius'?", "'size' of the parameter set",
                      "'count' of the parameter set"):
            self.assertIn(words, result.stderr)
        self.assertEqual(result.stderr.count("sets.json: warning"), 7)

    def test_a_set_that_is_not_there(self):
        result = self.run_in("check", "a.txt", "-p", "sets.json", "-P", "smal")
        self.assert_refused(result, 1, "E0241", "'smal'", "did you mean 'small'?",
                            "'small', 'native', 'odd'")

    def test_files_that_are_no_sets(self):
        for text, *words in (("{", "sets.json:1:", "not JSON"), ("[1]", "no parameter sets"),
                             ('{"parameterSets": 5}', "no parameter sets"),
                             ('{"parameterSets": {"small": 1}}', "no parameter sets"),
                             ('{"a": {}}', "no parameter sets"), ("5", "no parameter sets"),
                             ('{"parameterSets": {}}', "it has none"), ("", "not JSON"),
                             ("[" * 100000, "no parameter sets"),
                             ('{"parameterSets": {"small": {"size": ' + "[" * 100, "nested"),
                             ('{"x": "' + "\\u12", "not JSON")):
            self.write("sets.json", text)
            result = self.run_in("check", "a.txt", "-p", "sets.json", "-P", "small")
            self.assert_clean(result)
            self.assertIn(result.returncode, (1, 2))
            for word in words:
                self.assertIn(word, result.stderr)
        self.assert_refused(self.run_in("check", "a.txt", "-p", "gone.json", "-P", "small"), 2,
                            "gone.json", "No such file")
        self.assert_refused(self.run_in("check", "a.txt", "-p", ".", "-P", "small"), 2, "directory")

    def test_both_or_neither(self):
        self.assert_refused(self.run_in("check", "a.txt", "-p", "sets.json"), 2, "-P")
        self.assert_refused(self.run_in("check", "a.txt", "-P", "small"), 2, "-p")

    def test_the_mesh_follows(self):
        stats = self.stats("a.txt", "-q", "-r", "16", "-p", "sets.json", "-P", "small")
        self.assertAlmostEqual(stats["mesh"]["bounds"][1][2], 6, delta=0.1)


class Dependencies(ParamsTest):
    def test_all_that_was_read(self):
        self.write("lib.txt", "use <deep.txt>\nw = 1;\n")
        self.write("deep.txt", "module d() cube(1);\n")
        self.write("with space #1 $x.txt", "k = 2;\n")
        self.write("b.txt", "include <lib.txt>\ninclude <with space #1 $x.txt>\nradius = 1;\n"
                            "cube(k);\n")
        wanted = ["b.txt", "lib.txt", "deep.txt", "with space #1 $x.txt", "sets.json"]
        result = self.run_in("deps", "-q", "b.txt", "-p", "sets.json", "-P", "small")
        self.assert_status(result, 0)
        self.assertEqual(result.stdout.decode().splitlines(), wanted)
        result = self.run_in("b.txt", "-q", "-r", "4", "-o", "b.ply", "-M", "b.d", "-p", "sets.json",
                             "-P", "small")
        self.assert_status(result, 0)
        rule = self.read("b.d").decode()
        self.assertTrue(rule.startswith("b.ply:"))
        for name in wanted:
            self.assertIn(name.replace(" ", "\\ ").replace("#", "\\#").replace("$", "$$"), rule)


if __name__ == "__main__":
    cli.main()
