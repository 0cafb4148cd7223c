#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The sections of the literature's figures are drawn again, pixel for pixel as their pages show them.

    python3 tests/manual/test_sections.py CSGMESH
"""
import os
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path += [os.path.join(ROOT, "tools", "manual"), os.path.join(ROOT, "tests", "cli")]
import gallery  # noqa: E402
import png  # noqa: E402


def pixels(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return png.read(file.read())


def main():
    sections = [figure for figure in gallery.all_figures() if "--slice" in figure.options]
    assert len(sections) >= 20, len(sections)
    wrong, count = [], 0
    with tempfile.TemporaryDirectory() as folder:
        for figure in sections:
            gallery.draw(os.path.abspath(sys.argv[1]), figure, folder)
            for name, _ in figure.drawn():
                count += 1
                if pixels(folder, name) != pixels(gallery.FOLDER, name):
                    wrong.append(name)
    print(f"{count} sections, {len(wrong)} not as their pages show them: {' '.join(wrong)}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
