# SPDX-License-Identifier: MIT
"""Scenes of the repository and their meshes as bytes, for the tests of this folder."""
import glob
import hashlib
import os
import subprocess

from run_scenes import Expectations

SCENES = os.environ["CSGMESH_SCENES"]
FOLDERS = ["tour", "parts", "stress", "hard", "papers", os.path.join("..", "docs")]


def scenes():
    """Every scene that makes a mesh; names that begin with _ are parts of others."""
    paths = [path for folder in FOLDERS for path in glob.glob(os.path.join(SCENES, folder, "*.txt"))]
    paths = [path for path in paths if not os.path.basename(path).startswith("_")]
    return sorted(path for path in paths if not Expectations(path).of("error"))


def chosen_scenes(words):
    """Of the words `STEP` every STEP-th scene, of `--of N` the N-th, counted round and round."""
    every = scenes()
    assert len(every) >= 60, "where are the scenes?"
    if words and words[0] == "--of":
        return [every[int(words[1]) % len(every)]]
    return every[::int(words[0]) if words else 1]


def mesh(program, scene, out, *arguments, env=None):
    """Hash of the file that `program` writes to `out`; to standard output where `out` is "-"."""
    expect = Expectations(scene)
    command = [program, os.path.basename(scene), *expect.options, *map(str, arguments), "-o", out, "-q"]
    result = subprocess.run(command, cwd=os.path.dirname(scene), env={**os.environ, **(env or {})},
                            capture_output=True, timeout=1200, check=False)
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(command)}\n{result.stderr.decode(errors='replace')}")
    if out == "-":
        return hashlib.sha256(result.stdout).hexdigest()
    with open(out, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def differences(scene, first, variants):
    """`variants` is a list of (label, function giving a hash); those that are not like `first`."""
    name = os.path.relpath(scene, SCENES)
    return [f"{name}: {label}" for label, make in variants if make() != first]
