# SPDX-License-Identifier: MIT
"""instructions.py names what has become slower, and the kept counts are those of scenes that exist."""
import contextlib
import io
import os
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import instructions  # noqa: E402


class Instructions(unittest.TestCase):
    def compare(self, counts):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            slower = instructions.compare(counts, {"a": 1000, "b": 1000})
        return slower, said.getvalue()

    def test_slower(self):
        slower, said = self.compare({"a": 1099, "b": 1101})
        self.assertEqual(slower, ["b"])
        self.assertEqual(said.count("SLOWER"), 1)

    def test_faster_and_new(self):
        slower, said = self.compare({"a": 850, "c": 5})
        self.assertEqual(slower, [])
        self.assertIn("faster: renew", said)
        self.assertIn("c: 0.0 million; not in", said)

    def test_start_is_apart(self):
        """A library more makes the start dearer, and nothing else."""
        kept = {"start": 500, "a": 1000}
        for counts, expected in (({"start": 600, "a": 1100}, ["start"]), ({"start": 500, "a": 1060}, ["a"]), ({"start": 540, "a": 1080}, [])):
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(instructions.compare(counts, kept), expected)

    def test_failed(self):
        self.assertEqual(self.compare({"a": None})[0], ["a"])

    def test_kept(self):
        where, kept = instructions.read_baseline()
        self.assertIn("gcc", where)
        self.assertEqual(sorted(kept), sorted(instructions.scenes()))


if __name__ == "__main__":
    unittest.main()
