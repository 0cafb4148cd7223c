# SPDX-License-Identifier: MIT
"""tools/soak: findings are told and counted, what cannot run here is left out, seeds repeat, shares are fair."""
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
PATH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "soak")
LOADER = importlib.machinery.SourceFileLoader("soak", PATH)
SPEC = importlib.util.spec_from_loader("soak", LOADER)
soak = importlib.util.module_from_spec(SPEC)
sys.modules["soak"] = soak  # dataclasses look themselves up there
LOADER.exec_module(soak)


def search(name, shell, seedless=False):
    return soak.Search(name, "", 10, lambda build, seed: ["sh", "-c", shell, name, str(seed)], seedless)


class Soaking(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(setattr, soak, "FOLDER", soak.FOLDER)
        soak.FOLDER = folder.name

    def run_all(self, rows, seed=1, minutes=10):
        """Seedless searches end by themselves, so the minutes do not matter."""
        run, said = soak.Soak(rows, "build", seed, minutes), io.StringIO()
        with contextlib.redirect_stdout(said):
            run.work()
            run.report()
        return said.getvalue()

    def test_findings(self):
        rows = [search("good", "true", True), search("bad", "echo what is wrong; exit 3", True),
                search("absent", "exit 77", True)]
        said = self.run_all(rows)
        self.assertEqual([row.findings for row in rows], [0, 1, 0])
        self.assertEqual([row.skipped for row in rows], [False, False, True])
        self.assertIn("FINDING of bad, exit status 3", said)
        self.assertIn("what is wrong", said)
        self.assertIn("sh -c 'echo what is wrong; exit 3' bad", said)
        self.assertIn("1 findings", said)
        self.assertEqual(os.listdir(soak.FOLDER), ["bad-1.log"])

    def test_seeds(self):
        def seeds(base):
            run = soak.Soak([search("a", "true"), search("b", "true")], "build", base, 1)
            return [run.next_step()[1][-1] for _ in range(6)]
        self.assertEqual(seeds(5), seeds(5))
        self.assertNotEqual(seeds(5), seeds(6))
        self.assertEqual(len(set(seeds(5))), 6)

    def test_shares(self):
        cheap, dear = search("cheap", "true"), search("dear", "true")
        run, order = soak.Soak([cheap, dear], "build", 1, 1), []
        for _ in range(12):
            chosen, _ = run.next_step()
            chosen.running -= 1
            chosen.spent_s += 5 if chosen is dear else 1
            order.append(chosen.name)
        self.assertEqual(order.count("dear"), 2)

    def test_the_end(self):
        endless = search("endless", "exec sleep 1000")
        said = self.run_all([endless], minutes=0.002)
        self.assertEqual((endless.unfinished, endless.findings), (1, 0))
        self.assertIn("the time ended a step", said)

    def test_names(self):
        rows = soak.searches()
        self.assertTrue(all(row.name.startswith("fuzz-") for row in soak.chosen(rows, ["fuzz"])))
        self.assertEqual([row.name for row in soak.chosen(rows, ["meshes"])], ["meshes"])
        with self.assertRaises(SystemExit):
            soak.chosen(rows, ["nothing"])


if __name__ == "__main__":
    unittest.main()
