# SPDX-License-Identifier: MIT
"""What the tests of the package share: the program to compare with, and an empty folder for each test."""
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(os.environ.get("CSGMESH_ROOT_FOLDER", pathlib.Path(__file__).parents[2]))
SCENES = ROOT / "scenes"
PARTS = sorted((SCENES / "parts").glob("*.txt"))
ENDLESS = "for (i = [0 : 99999]) for (j = [0 : 99999]) if (i < 0) sphere(i);\n"


def csgmesh_program(*arguments, status=0, cwd=None):
    """Runs the command line; its standard output."""
    result = subprocess.run([os.environ["CSGMESH"], *map(str, arguments)], capture_output=True, cwd=cwd, check=False)
    assert result.returncode == status, result.stderr.decode()
    return result.stdout


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path
