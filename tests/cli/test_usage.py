# SPDX-License-Identifier: MIT
"""Help, version and mistakes on the command line: a message that says what to do, exit status 2."""
import json
import os

import cli


class Help(cli.CliTest):
    def test_help_teaches_by_examples(self):
        for arguments in (["--help"], ["-h"], ["help"]):
            result = cli.run(*arguments)
            self.assert_status(result, 0)
            text = result.stdout.decode()
            self.assertIn("csgmesh mug.txt -o mug.glb", text)
            for command in ("mesh", "check", "info", "eval", "dump", "params", "deps"):
                self.assertIn(f"\n  {command}", text)

    def test_help_of_commands(self):
        for command, option in (("mesh", "--stats[=FILE]"), ("check", "-Werror"),
                                ("info", "--json"), ("eval", "--at X,Y,Z"), ("dump", "--tape"),
                                ("deps", "--include DIR")):
            for arguments in (["help", command], [command, "--help"]):
                result = cli.run(*arguments)
                self.assert_status(result, 0)
                self.assertIn(option, result.stdout.decode())
                self.assertIn(f"csgmesh {command}" if command != "mesh" else "csgmesh mug.txt",
                              result.stdout.decode())
                self.assertFalse([line for line in result.stdout.decode().splitlines()
                                  if len(line) > 100 or line.endswith(" ")])

    def test_no_arguments_shows_the_help(self):
        result = cli.run()
        self.assert_status(result, 2)
        self.assertIn(b"Usage", result.stdout)

    def test_version(self):
        result = cli.run("--version")
        self.assert_status(result, 0)
        first, *features = result.stdout.decode().splitlines()
        self.assertRegex(first, r"^csgmesh \d+\.\d+\.\d+ \((avx512|avx2|sse2|neon|scalar)\)$")
        for library in ("Clipper", "Qhull", "FreeType", "FriBidi", "fontconfig", "libpng", "Draco", "tinygltf",
                        "libzip", "nlohmann-json"):
            lines = [line for line in features if library in line]
            self.assertEqual(len(lines), 1, features)
            self.assertRegex(lines[0], rf"^(with {library} \d+\.\d+\S*|without .*{library}).* \(.+\)$")
        bill_path = os.path.join(os.environ["CSGMESH_BUILD"], "csgmesh.cdx.json")
        if os.path.exists(bill_path):  # a build for another machine has none
            with open(bill_path, encoding="utf-8") as file:
                bill = json.load(file)
            self.assertEqual(bill["metadata"]["component"]["version"], first.split()[1])
            listed = {f"{part['name']} {part['version']}" for part in bill["components"]}
            said = [part for line in features if line.startswith("with ")
                    for part in line[len("with "):line.index(" (")].split(", ")]
            self.assertLessEqual(set(said), listed)
        scalar = cli.run("--version", env={"CSGMESH_ISA": "scalar"})
        self.assertIn(b"(scalar)", scalar.stdout)

    def test_unknown_instruction_set(self):
        self.assert_refused(cli.run("--version", env={"CSGMESH_ISA": "mmx"}), 2, "CSGMESH_ISA",
                            "mmx")


class Mistakes(cli.CliTest):
    def refused(self, *arguments, words=()):
        self.write("a.txt", cli.BALL)
        result = self.run_in(*arguments)
        self.assert_refused(result, 2, "csgmesh: error: ", *words)
        self.assert_files("a.txt")

    def test_no_output(self):
        self.refused("a.txt", words=["no output file", "add -o a.glb"])

    def test_no_scene(self):
        self.refused("-o", "a.glb", words=["no scene"])

    def test_two_scenes(self):
        self.refused("a.txt", "a.txt", "-o", "a.glb", words=["one scene at a time"])

    def test_unknown_option(self):
        self.refused("a.txt", "--reslution", "5", "-o", "a.glb",
                     words=["unknown option '--reslution'", "did you mean '--resolution'"])
        self.refused("a.txt", "-Z", "-o", "a.glb", words=["unknown option '-Z'"])

    def test_option_of_another_command(self):
        self.refused("check", "a.txt", "-o", "a.glb", words=["does not apply"])
        self.refused("a.txt", "--at", "1,2,3", "-o", "a.glb", words=["does not apply"])

    def test_values(self):
        for option in (["-r", "0"], ["-r", "12x"], ["-r", "-5"], ["-r", "99999999999"], ["-s", "0"],
                       ["-s", "nan"], ["-s", "inf"], ["--bounds", "0,0,0,1,1"],
                       ["--bounds", "0,0,0,1,1,0"], ["--bounds", "0,0,0,1,1,1,"], ["-j", "0"],
                       ["--max-memory", "2Q"], ["--max-memory", "-1"], ["--timeout", "0"],
                       ["--draco-bits", "31"], ["--draco-bits", "14,"], ["--draco-level", "11"],
                       ["--unit", "yard"], ["--color", "pink"], ["-W", "all"], ["--ascii=yes"]):
            self.refused("a.txt", "-o", "a.glb", *option)
        self.refused("a.txt", "-o", words=["needs FILE"])

    def test_define_without_value(self):
        for text in ("radius", "=5", "2r=5", "a b=5"):
            self.refused("a.txt", "-o", "a.glb", "-D", text, words=["NAME=EXPR"])

    def test_resolution_and_cell_size(self):
        self.refused("a.txt", "-o", "a.glb", "-r", "9", "-s", "1", words=["give one"])

    def test_formats(self):
        self.refused("a.txt", "-o", "a.nothing", words=["tells no format", "formats: obj ply"])
        self.refused("a.txt", "-o", "-", words=["add -f"])
        self.refused("a.txt", "-o", "a.glb", "-f", "doc", words=["unknown format 'doc'"])

    def test_collisions(self):
        self.refused("a.txt", "-o", "a.glb", "-o", "a.glb", words=["both write to"])
        self.refused("a.txt", "-f", "ply", "-o", "-", "--stats", words=["standard output"])
        self.refused("a.txt", "-f", "ply", "-o", "-", "-M", "a.d", words=["-M needs an output"])

    def test_dump_and_eval(self):
        self.refused("dump", "a.txt", words=["--scene, --tape, --vm or --csg"])
        self.refused("dump", "--scene", "--tape", "a.txt", words=["--scene, --tape, --vm or --csg"])
        self.refused("eval", "a.txt", words=["add --at"])
        self.refused("eval", "a.txt", "--at", "1,2", words=["X,Y,Z"])


class Order(cli.CliTest):
    """Options may stand before the command."""

    def test_options_before_the_command(self):
        self.write("a.txt", cli.BALL)
        usual = self.run_in("info", "--json", "-r", "8", "a.txt")
        self.assert_status(usual, 0)
        for arguments in (["-q", "info", "--json", "-r", "8", "a.txt"],
                          ["-r", "8", "--json", "info", "a.txt"],
                          ["-qr8", "info", "a.txt", "--json"],
                          ["--resolution=8", "-D", "x=1", "info", "-q", "--json", "a.txt"]):
            result = self.run_in(*arguments)
            self.assert_status(result, 0)
            self.assertEqual(result.stdout, usual.stdout)
        self.assertIn(b"csgmesh deps", self.run_in("-q", "help", "deps").stdout)
        # --json takes a value with diff and none with info
        self.assert_status(self.run_in("-q", "--json", "d.json", "diff", "a.txt", "a.txt"), 0)
        self.assertEqual(json.loads(self.read("d.json"))["verdict"], "same")

    def test_an_options_value_is_no_command(self):
        self.write("a.txt", cli.BALL)
        self.assert_status(self.run_in("-o", "info", "-f", "ply", "a.txt", "-r", "8"), 0)
        self.assert_files("a.txt", "info")

    def test_behind_a_double_dash_stand_files(self):
        self.write("check", cli.BALL)
        self.assert_status(self.run_in("-r", "8", "-o", "a.ply", "--", "check"), 0)
        self.assert_files("a.ply", "check")


class Effects(cli.CliTest):
    def test_options_without_effect_say_so(self):
        self.write("a.txt", cli.BALL)
        for option in (["--unit", "mm"], ["--up", "z"], ["--draco-level", "3"]):
            result = self.run_in("a.txt", "-r", "8", "-o", "a.stl", *option)
            self.assert_status(result, 0)
            self.assertIn(f"warning: {option[0]} has no effect", result.stderr)
            quiet = self.run_in("a.txt", "-q", "-r", "8", "-o", "a.stl", *option)
            self.assertEqual(quiet.stderr, "")

    def test_double_dash_ends_the_options(self):
        self.write("-a.txt", cli.BALL)
        self.assert_status(self.run_in("-r", "8", "-o", "a.ply", "--", "-a.txt"), 0)

    def test_a_scene_named_like_a_command(self):
        self.write("check", cli.BALL)
        self.assert_status(self.run_in("mesh", "check", "-r", "8", "-o", "a.ply"), 0)


if __name__ == "__main__":
    cli.main()
