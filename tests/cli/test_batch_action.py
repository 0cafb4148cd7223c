# SPDX-License-Identifier: MIT
"""The GitHub Action: its file is sound, its matcher reads csgmesh's findings, and its shell steps do on
this machine what they do there, with a `gh` that writes down what it is told.
"""
import json
import os
import re
import shutil
import stat
import subprocess
import unittest

import cli
from batch_support import BatchTest

try:
    import yaml
except ImportError:
    yaml = None

ACTION = os.path.join(os.environ["CSGMESH_SHARE"], "github/csgmesh")
# Stands for GitHub: the list has the comment that this folder remembers, POST and PATCH write its body.
GH = """#!/bin/sh
echo "$*" >>'{log}'
case $* in
*--paginate*) if [ -f '{comment}' ] && head -1 '{comment}' | grep -qF "$(echo "$*" | sed 's/.*startswith("//; s/").*//')"; then echo 4711; fi ;;
*) for word; do case $word in body=@*) cat "${{word#body=@}}" >'{comment}' ;; esac; done ;;
esac
"""


def diff_is_there():
    return b"csgmesh diff" in cli.run("help", "diff").stdout


class Files(unittest.TestCase):
    @unittest.skipUnless(yaml, "no PyYAML")
    def test_action(self):
        with open(os.path.join(ACTION, "action.yml"), encoding="utf-8") as file:
            action = yaml.safe_load(file)
        inputs = set(action["inputs"])
        text = json.dumps(action)
        self.assertEqual(set(re.findall(r"inputs\.(\w+)", text)), inputs)
        ids = {step.get("id") for step in action["runs"]["steps"]}
        self.assertLessEqual(set(re.findall(r"steps\.(\w+)\.", text)), ids)
        self.assertEqual(action["runs"]["using"], "composite")
        for step in action["runs"]["steps"]:
            self.assertEqual(step["shell"], "bash")
            self.assertNotIn("${{", step["run"], "inputs go through the environment")
            for script in re.findall(r"GITHUB_ACTION_PATH/(\S+?)\"", step["run"]):
                self.assertTrue(os.path.exists(os.path.join(ACTION, script)), script)

    def test_scripts(self):
        for name in os.listdir(ACTION):
            path = os.path.join(ACTION, name)
            if name.endswith(".sh"):
                subprocess.run(["bash", "-n", path], check=True)
                if shutil.which("shellcheck"):
                    subprocess.run(["shellcheck", path], check=True)
            if name.endswith((".sh", ".py")):
                self.assertTrue(os.stat(path).st_mode & stat.S_IXUSR, name)

    def test_matcher(self):
        with open(os.path.join(ACTION, "problem-matcher.json"), encoding="utf-8") as file:
            pattern = json.load(file)["problemMatcher"][0]["pattern"][0]
        test = cli.CliTest()
        test.setUp()
        test.write("bad.txt", "a = 1;\na = 2;\nsphere(r = );\n")
        lines = test.run_in("batch", "bad.txt", "-d", "out").stderr.splitlines()
        found = [m for m in (re.match(pattern["regexp"], line) for line in lines) if m]
        test.doCleanups()
        self.assertTrue(found, lines)
        error = found[-1]
        self.assertEqual((error[pattern["file"]], error[pattern["line"]],
                          error[pattern["severity"]]), ("bad.txt", "3", "error"))
        self.assertRegex(error[pattern["code"]], "^E[0-9]{4}$")


@unittest.skipUnless(shutil.which("bash"), "no bash")
class Steps(BatchTest):
    def setUp(self):
        super().setUp()
        self.scenes()
        for folder in ("bin", "temp"):
            os.mkdir(self.path(folder))
        self.write("bin/gh", GH.format(log=self.path("gh.log"), comment=self.path("comment.md")))
        os.chmod(self.path("bin/gh"), 0o755)
        self.write("parts.json", json.dumps({"resolution": 12, "jobs": ["mug.txt", "ball.txt"]}))

    def step(self, script, status=0, **variables):
        env = {**os.environ, "PATH": self.path("bin") + ":" + os.environ["PATH"],
               "RUNNER_TEMP": self.path("temp"), "GITHUB_STEP_SUMMARY": self.path("summary.md"),
               "GITHUB_OUTPUT": self.path("outputs.txt"), "PULL_REQUEST": "7", "GITHUB_REPOSITORY": "me/parts",
               "CSGMESH": cli.PROGRAM, "MANIFEST": "parts.json", "DIRECTORY": "out",
               "OPTIONS": "-q", "GOLDENS": "goldens", "TOLERANCE": "0.001", **variables}
        result = subprocess.run(["bash", os.path.join(ACTION, script)], cwd=self.folder, env=env,
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result

    def verdict(self, status):
        for name in ("summary.md", "outputs.txt", "gh.log"):
            if os.path.exists(self.path(name)):
                os.remove(self.path(name))
        self.step("comment.sh")
        self.step("outcome.sh", status)
        comment = self.read("gh.log").decode() if os.path.exists(self.path("gh.log")) else ""
        if "--method" in comment:
            comment += self.read("comment.md").decode()
        else:
            comment = ""
        return self.read("outputs.txt").decode().strip(), comment

    def stand_in(self, name, text):
        self.write(f"bin/{name}", f"#!/bin/sh\necho \"{name} $*\" >>'{self.path('calls.log')}'\n{text}\n")
        os.chmod(self.path(f"bin/{name}"), 0o755)

    def install(self, status=0, csgmesh="csgmesh-of-the-package", package="", source=""):
        for name in ("calls.log", "path.txt"):
            self.write(name, "")
        result = self.step("install.sh", status, CSGMESH=csgmesh, PACKAGE=package, SOURCE=source,
                           GITHUB_PATH=self.path("path.txt"))
        return result.stdout, self.read("calls.log").decode()

    def test_install_a_package(self):
        """apt-get gets the file, or what curl brought; then the program is there."""
        self.stand_in("sudo", '"$@"')
        self.stand_in("apt-get", f"case $* in *' install '*) cp '{cli.PROGRAM}' '{self.path('bin')}/csgmesh-of-the-package';; esac")
        self.stand_in("curl", 'while [ "$1" != --output ]; do shift; done; echo a package >"$2"')
        self.write("a.deb", "a package")
        said, calls = self.install(package="a.deb")
        self.assertIn(f"install {self.path('a.deb')}\n", calls)
        self.assertNotIn("curl", calls)
        self.assertIn("csgmesh ", said)
        os.remove(self.path("bin/csgmesh-of-the-package"))
        _, calls = self.install(package="https://example.org/b.deb")
        self.assertIn("https://example.org/b.deb\n", calls)
        self.assertIn(f"install {self.path('temp/csgmesh.deb')}\n", calls)

    def test_install_from_source(self):
        os.makedirs(self.path("clone/tools"))
        self.write("clone/tools/run", "#!/bin/sh\nmkdir -p clone/build/tools/csgmesh\n"
                   f"cp '{cli.PROGRAM}' clone/build/tools/csgmesh/csgmesh-of-the-package\n")
        os.chmod(self.path("clone/tools/run"), 0o755)
        self.install(source="clone")
        self.assertEqual(self.read("path.txt").decode(), os.path.realpath(self.path("clone/build/tools/csgmesh")) + "\n")

    def test_install_that_fails(self):
        self.stand_in("curl", "exit 22")
        self.stand_in("apt-get", "exit 100")
        for status, words, arguments in (
                (2, "give the action a package", {}),
                (2, "there is no package none.deb", {"package": "none.deb"}),
                (2, "https://example.org/b.deb could not be had", {"package": "https://example.org/b.deb"}),
                (2, "is no clone of csgmesh", {"source": "bin"}),
                (2, "give one", {"source": "bin", "package": "a.deb"})):
            said, _ = self.install(status, **arguments)
            self.assertIn("::error::csgmesh: ", said)
            self.assertIn(words, said)
        said, calls = self.install(csgmesh=cli.PROGRAM) # it is there already
        self.assertEqual(calls, "")

    def test_without_goldens(self):
        self.step("mesh.sh")
        self.assertEqual(sorted(self.outputs()), ["ball.glb", "mug.glb"])
        self.assertEqual(self.verdict(0), ("outcome=same", ""))

    def test_a_scene_with_a_fault(self):
        self.write("ball.txt", "sphere(;\n")
        result = self.step("mesh.sh")
        self.assertIn("ball.txt:1:8: error", result.stderr)
        outcome, comment = self.verdict(1)
        self.assertEqual(outcome, "outcome=failed")
        self.assertIn("--method POST repos/me/parts/issues/7/comments", comment)
        self.assertIn("Not all scenes could be meshed", comment)

    @unittest.skipUnless(diff_is_there(), "no csgmesh diff in this build")
    def test_a_changed_parameter(self):
        self.step("mesh.sh", DIRECTORY="goldens")
        shutil.rmtree(self.path("goldens/.csgmesh-cache"))
        self.step("mesh.sh")
        self.step("compare.sh")
        self.assertEqual(self.verdict(0), ("outcome=same", ""))
        before = self.read("mug.txt")
        self.write("mug.txt", "include <lib/base.txt>\nradius = 5;\nbase(radius);\n")
        self.step("mesh.sh")
        self.step("compare.sh")
        outcome, comment = self.verdict(1)
        self.assertEqual(outcome, "outcome=different")
        self.assertIn("Meshes differ", comment)
        self.assertRegex(comment, r"\| mug.glb \| different: .*\| \+\d+\.\d+ % \|")
        self.assertNotIn("ball.glb", comment)
        self.assertIn("Meshes differ", self.read("summary.md").decode())
        self.assertIn("--method POST", comment)
        outcome, comment = self.verdict(1) # the comment is there: it is brought up to date
        self.assertIn("--method PATCH repos/me/parts/issues/comments/4711", comment)
        self.write("mug.txt", before)
        self.step("mesh.sh")
        self.step("compare.sh")
        outcome, comment = self.verdict(0)
        self.assertEqual(outcome, "outcome=same")
        self.assertIn("--method PATCH", comment)
        self.assertIn("All meshes are well again", comment)

    def test_another_marker_is_another_comment(self):
        self.write("ball.txt", "sphere(;\n")
        self.step("mesh.sh")
        self.verdict(1)
        self.step("comment.sh", MARKER="of another workflow")
        self.assertIn("<!-- csgmesh meshes of another workflow -->", self.read("comment.md").decode())
        self.assertEqual(self.read("gh.log").decode().count("--method POST"), 2)

    def test_table_of_one_comparison(self):
        self.write("d.json", json.dumps({
            "file_a": "goldens/a.glb", "file_b": "out/a.glb", "verdict": "different",
            "reasons": ["distance"], "hausdorff": [0.5, 0.5], "a": {"volume": 2, "triangles": 10},
            "b": {"volume": 1, "triangles": 12},
            "a_to_b": {"worst": [{"at": [1, 2, 3], "distance": 0.5}]}}))
        result = subprocess.run(["python3", os.path.join(ACTION, "table.py"), self.path("d.json")],
                                capture_output=True, text=True, check=True)
        self.assertIn("| a.glb | different: distance | 0.5 | 1, 2, 3 | -50.00 % | 10 to 12 |",
                      result.stdout)


if __name__ == "__main__":
    cli.main()
