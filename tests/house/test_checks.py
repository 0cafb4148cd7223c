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
    def trees(self, texts):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for path, text in texts.items():
            full = os.path.join(folder.name, path)
            os.makedirs(os.path.dirname(full), exist_ok=True)
            with open(full, "w", encoding="utf-8") as file:
                file.write(text)
        return folder.name

    def tree(self, path, text):
        return self.trees({path: text})

    def found(self, script, path, text):
        return self.found_in(script, {path: text})

    def found_in(self, script, texts):
        result = check(script, self.trees(texts))
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
                ("tools/csgmesh/a.c", '"scene/scene.h"', "slicing.h only"),
                ("src/lang/a.c", '"scene/scene.h"', ""),
                ("tools/csgmesh/a.c", '"csgmesh/csgmesh.h"', ""),
                ("src/base/a.c", "<stdio.h>", "")):
            found = self.found("check_layers.py", path, f"#include {include}\n")
            self.assertEqual(bool(found), bool(fault), f"{path} {include}: {found}")
            self.assertIn(fault, found)

    def test_circles(self):
        def text(*names):
            return "".join(f'#include "{name}"\n' for name in names)
        there = {"src/base/a.c": text("base/a.h", "base/b.h"), "src/base/a.h": "", "src/base/b.c": text("base/b.h")}
        self.assertEqual(self.found_in("check_layers.py", {**there, "src/base/b.h": ""}), "")
        for back in ({"src/base/b.h": text("base/a.h")},
                     {"src/base/b.h": "", "src/base/b.c": text("base/c.h"), "src/base/c.h": text("base/a.h")}):
            self.assertIn("circle: base/a, base/b", self.found_in("check_layers.py", {**there, **back}))
        private = {"src/base/a.c": text("base/a.h", "base/a_private.h"), "src/base/a.h": "",
                   "src/base/a_private.h": text("base/a.h")}
        self.assertEqual(self.found_in("check_layers.py", private), "")

    def test_names(self):
        one = {"src/a/a.h": HEAD + "typedef struct csg_thing {\n    int x;\n} csg_thing;\n"}
        for other, fault in (("typedef struct csg_thing csg_thing;\nstruct csg_thing {\n    int x;\n};\n", True),
                             ("enum csg_thing { A, B };\n", True), ("typedef int csg_thing;\n", True),
                             ("typedef struct csg_thing csg_thing;\n", False), ("csg_thing thing;\n", False)):
            found = self.found_in("check_house.py", {**one, "src/b/b.c": HEAD + other})
            self.assertEqual("csg_thing is defined in" in found, fault, other + found)
        two = {f"src/a/{name}.c": HEAD + "typedef struct row {\n    int x;\n} row;\n" for name in "ab"}
        self.assertEqual(self.found_in("check_house.py", two), "", "types of one file each")
        function = "static int run(void)\n{\n}\n"
        self.assertIn("called run", self.found("check_house.py", "src/io/a.c", HEAD + function))
        self.assertEqual(self.found("check_house.py", "src/io/a.c", HEAD + function.replace("run", "run_it")), "")

    def test_house(self):
        body = "    work();\n"
        long_function = "int f(void)\n{\n" + 90 * body + "}\n"
        short_function = "int f(void)\n{\n" + 70 * body + "}\n"
        self.assertIn("f has 93 lines", self.found("check_house.py", "src/a/a.c",
                                                   HEAD + long_function))
        self.assertEqual(self.found("check_house.py", "src/a/a.c", HEAD + short_function), "")
        self.assertIn("no SPDX", self.found("check_house.py", "src/a/a.c", short_function))
        self.assertIn("701 lines", self.found("check_house.py", "src/a/a.c", HEAD + 700 * "\n"))

    def test_mathematics(self):
        for call, fault in (("hypot(a, b)", "hypot"), ("std::atan2(a, b)", "atan2"), ("powf (a, b)", "powf"), ("1 / log10(a)", "log10"),
                            ("csg_sin(a)", ""), ("sqrt(a)", ""), ("p->sin(a)", ""), ("0 /* sin(a) */", ""), ('word("cos(a)")', "")):
            found = self.found("check_house.py", "src/io/a.c", HEAD + f"int f(void)\n{{\n    return {call};\n}}\n")
            self.assertEqual(f"{fault}() has other bits" in found if fault else found != "", bool(fault), call + found)
        self.assertEqual(self.found("check_house.py", "src/base/elementary.c", HEAD + "double x = sin(1);\n"), "")
        self.assertEqual(self.found("check_house.py", "tools/a.c", HEAD + "double x = sin(1);\n"), "")

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
