# SPDX-License-Identifier: MIT
"""The checks of the tree find what they are for: each planted fault is reported."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

TOOLS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools")
HEAD = "/* SPDX-License-Identifier: MIT */\n"


def check(script, *arguments):
    return subprocess.run([sys.executable, os.path.join(TOOLS, script), *arguments],
                          capture_output=True, text=True, check=False)


class Planted(unittest.TestCase):
    def tree(self, path, text):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        full = os.path.join(folder.name, path)
        os.makedirs(os.path.dirname(full))
        with open(full, "w", encoding="utf-8") as file:
            file.write(text)
        return folder.name

    def found(self, script, path, text):
        result = check(script, self.tree(path, text))
        self.assertEqual(result.returncode, 1 if result.stdout else 0, result.stderr)
        return result.stdout

    def test_layers(self):
        for path, include, fault in (
                ("src/scene/a.c", '"lang/lang.h"', "must not know"),
                ("src/scene/a.c", '"text/source.h"', "know nothing of text"),
                ("src/mesh/a.c", '"mesh.h"', "from src/"),
                ("src/mesh/remesh/a.c", '"mesh/reshape/tolerance.h"', "must not know"),
                ("src/mesh/odd/a.c", '"mesh/remesh/remesh.h"', "no folder 'odd'"),
                ("src/mesh/reshape/a.c", '"mesh/remesh/remesh.h"', ""),
                ("src/odd/a.c", '"base/memory.h"', "no layer"),
                ("tools/csgmesh/a.c", '"scene/scene.h"', "csgmesh.h only"),
                ("src/lang/a.c", '"scene/scene.h"', ""),
                ("tools/csgmesh/a.c", '"csgmesh/csgmesh.h"', ""),
                ("src/base/a.c", "<stdio.h>", "")):
            found = self.found("check_layers.py", path, f"#include {include}\n")
            self.assertEqual(bool(found), bool(fault), f"{path} {include}: {found}")
            self.assertIn(fault, found)

    def test_house(self):
        body = "    work();\n"
        long_function = "int f(void)\n{\n" + 90 * body + "}\n"
        short_function = "int f(void)\n{\n" + 70 * body + "}\n"
        self.assertIn("f has 93 lines", self.found("check_house.py", "src/a/a.c",
                                                   HEAD + long_function))
        self.assertEqual(self.found("check_house.py", "src/a/a.c", HEAD + short_function), "")
        self.assertIn("no SPDX", self.found("check_house.py", "src/a/a.c", short_function))
        self.assertIn("701 lines", self.found("check_house.py", "src/a/a.c", HEAD + 700 * "\n"))

    def test_paths(self):
        page = "See src/a/b.c, `tests/none.c`, scenes/*.txt, src/NAME.c and https://x.org/src/gone.c.\n"
        self.assertEqual(self.found("check_house.py", "docs/page.md", page),
                         "docs/page.md:1: src/a/b.c is not there\ndocs/page.md:1: tests/none.c is not there\n")
        self.assertEqual(self.found("check_house.py", "docs/page.md", "See docs/page.md and docs.\n"), "")
        code = HEAD + '#include "gone/away.h"\n\nstatic const char *name = "gone/away.c"; // as room/gone.c has it\n'
        self.assertEqual(self.found("check_house.py", "src/room/a.c", code),
                         "src/room/a.c:4: room/gone.c is not there\n")
        self.assertEqual(self.found("check_house.py", "src/room/a.c", HEAD + "/* as room/a.c has it */\n"), "")
        script = "# SPDX-License-Identifier: MIT\n# in tools/gone\nplace = 'tools/away'\n"
        self.assertEqual(self.found("check_house.py", "tools/a.py", script), "tools/a.py:2: tools/gone is not there\n")

    def test_counting(self):
        results = ["OK", "OK", "FAIL", "TIMEOUT", "SKIP", "ERROR", "EXPECTEDFAIL"]
        log = "".join(json.dumps({"name": "x", "result": r}) + "\n" for r in results)
        path = os.path.join(self.tree("logs/log.json", log), "logs", "log.json")
        result = check("count_tests.py", path, "no-such-log.json")
        self.assertEqual(result.stdout, "3 passed, 3 failed, 1 skipped\n")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(check("count_tests.py").returncode, 1)


if __name__ == "__main__":
    unittest.main()
