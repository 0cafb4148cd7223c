# SPDX-License-Identifier: MIT
"""What the tests of csgmesh batch share: a folder of scenes, and what a run did with them."""
import hashlib
import json
import os

import cli

MUG = "include <lib/base.txt>\nradius = 4; // [1:10]\nbase(radius);\n"
BOX = 'part("lid") translate([0, 0, 5]) sphere(2);\npart("box") cube(3);\n'
BASE = "module base(r) sphere(r);\n"
SETS = {"parameterSets": {"small": {"radius": "2"}, "large": {"radius": "8"}},
        "fileFormatVersion": "1"}


def needs_hashes(test):
    return cli.unittest.skipUnless(cli.has_library("libb2"), "no libb2 in this build")(test)


class BatchTest(cli.CliTest):
    def scenes(self):
        os.makedirs(self.path("lib"), exist_ok=True)
        self.write("mug.txt", MUG)
        self.write("box.txt", BOX)
        self.write("ball.txt", cli.BALL)
        self.write("lib/base.txt", BASE)
        self.write("sets.json", json.dumps(SETS))

    def batch(self, *arguments, status=0, **options):
        """Runs it with --json; {first output: outcome}, and the summary under None."""
        result = self.run_in("batch", *arguments, "--json", **options)
        self.assert_clean(result)
        self.assert_status(result, status)
        self.messages = result.stderr
        self.lines = [json.loads(line) for line in result.stdout.splitlines()]
        outcomes = {}
        for line in self.lines[:-1]:
            name = line["outputs"][0]["file"] if line.get("outputs") else line["scene"]
            outcomes[name] = line["outcome"]
        outcomes[None] = self.lines[-1]
        return outcomes

    def outputs(self, folder="out"):
        """{name below the folder: bytes} without what is known of them. A file that a batch still running
        renames or removes meanwhile is left out."""
        found = {}
        for place, folders, names in os.walk(self.path(folder)):
            folders[:] = [f for f in folders if f != ".csgmesh-cache"]
            for name in names:
                path = os.path.join(place, name)
                try:
                    with open(path, "rb") as file:
                        found[os.path.relpath(path, self.path(folder))] = file.read()
                except FileNotFoundError:
                    pass
        return found

    def times(self, folder="out"):
        return {name: os.stat(self.path(os.path.join(folder, name))).st_mtime_ns
                for name in self.outputs(folder)}

    def many(self, count, folder="s", text="sphere(r = {r});\ncube([{r}, 2, {n}]);\n"):
        os.makedirs(self.path(folder), exist_ok=True)
        names = []
        for n in range(count):
            names.append(self.write(f"{folder}/a{n}.txt", text.format(r=1 + n % 7, n=1 + n / 100)))
        return names


def digest(files):
    return {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}
