# SPDX-License-Identifier: MIT
"""Runs every scene of a folder and checks what its head says of it.

    //! expect volume 4.18879 0.5%      of the mesh, with a tolerance
    //! expect area 12.566 1%
    //! expect euler 2
    //! expect components 1
    //! expect bounds -1 -1 -1 1 1 1 0.01     of the mesh, with a tolerance in scene units
    //! expect error E0107              the scene is refused (exit status 1 or, for limits, 2)
    //! expect warning W0402
    //! expect echo "x", 1              a line ECHO: "x", 1
    //! resolution 64                   default 128
    //! options -D "wall=2" --max-depth 50
    //! needs MCAD/gears.scad           skipped where no folder of libraries has that file
    //! normal euler 4              what `expect euler` is by default, without -r

By default bounds may be off by the tolerance, the volume by six tenths of it all over the surface, the area by as
much as expected or 2 %; equal cells' warnings of thin parts do not come, and that a place is farther than
the tolerance (W0410) is no fault of the scene.

A scene without `expect error` must give a closed oriented manifold, and may warn only of what it says.
Usage: run_scenes.py FOLDER [normal]; exit status 77 when the folder holds no scenes.
"""
import json
import os
import re
import shlex
import sys
import tempfile

import cli


class Expectations:
    """The //! lines of a scene."""

    def __init__(self, path, follows=False):
        self.values, self.resolution, self.options, self.follows, self.needs = [], 128, [], follows, []
        normal = {}
        with open(path, encoding="utf-8", errors="replace") as file:
            for line in file:
                words = line.split()
                if words[:1] != ["//!"] or len(words) < 3:
                    continue
                if words[1] == "expect":
                    self.values.append((words[2], line.split("expect", 1)[1].split(None, 1)[1]
                                        .strip() if len(words) > 3 else "", words[3:]))
                elif words[1] == "normal":
                    normal[words[2]] = words[3:]
                elif words[1] == "resolution":
                    self.resolution = int(words[2])
                elif words[1] == "needs":
                    self.needs.append(words[2])
                elif words[1] == "options":
                    self.options = shlex.split(line.split("options", 1)[1])
                else:
                    raise ValueError(f"{path}: what is '{line.strip()}'?")
        if follows:
            self.values = [value for value in self.values if value[0] not in normal and value[2][:1] != ["W0406"]]
            self.values += [(name, " ".join(words), words) for name, words in normal.items()]

    def lacks(self):
        """What it needs and no folder of libraries has."""
        folders = [folder for name in ("CSGMESH_PATH", "OPENSCADPATH")
                   for folder in os.environ.get(name, "").split(os.pathsep) if folder]
        folders += [os.path.expanduser("~/.local/share/OpenSCAD/libraries"), "/usr/share/openscad/libraries"]
        return [name for name in self.needs if not any(os.path.exists(os.path.join(f, name)) for f in folders)]

    def how(self):
        """The options of the mesh."""
        return ([] if self.follows else ["-r", self.resolution]) + self.options

    def of(self, kind):
        return [words for name, _, words in self.values if name == kind]

    def texts(self, kind):
        return [text for name, text, _ in self.values if name == kind]


def compare(name, found, words, room=0.0):
    """A fault, or None: `found` against VALUE [TOLERANCE%|TOLERANCE], or within `room`."""
    expected = float(words[0])
    tolerance = 0.0
    if len(words) > 1:
        share = words[1].endswith("%")
        tolerance = float(words[1].rstrip("%")) * (abs(expected) / 100 if share else 1)
    if abs(found - expected) <= max(tolerance, room):
        return None
    return f"{name} is {found!r}, expected {' '.join(words)}"


def compare_bounds(bounds, words, room=0.0):
    numbers = [float(word) for word in words]
    tolerance = numbers[6] if len(numbers) > 6 else 1e-6
    found = bounds[0] + bounds[1]
    if all(abs(a - b) <= max(tolerance, room) for a, b in zip(found, numbers)):
        return None
    return f"bounds are {found}, expected {' '.join(words)}"


def check_findings(result, expect):
    """Warnings, errors and echoes: all that is expected, and no finding that is not."""
    found = set(re.findall(r"(?:error|warning) ([EW]\d{4}):", result.stderr)) - ({"W0410"} if expect.follows else set())
    expected = {words[0] for kind in ("error", "warning") for words in expect.of(kind)}
    for code in sorted(expected - found):
        yield f"{code} was expected and not reported"
    for code in sorted(found - expected):
        yield f"{code} was reported and not expected"
    for text in expect.texts("echo"):
        if f"ECHO: {text}" not in result.stderr.splitlines():
            yield f"no line 'ECHO: {text}'"


def check_mesh(stats, expect):
    mesh = stats["mesh"]
    for key in ("boundary_edges", "nonmanifold_edges", "misoriented_edges", "nonmanifold_vertices"):
        if mesh[key]:
            yield f"the mesh has {mesh[key]} {key}"
    tolerance = stats["lattice"].get("tolerance", 0.0)
    room = {"volume": 0.6 * tolerance * mesh["area"], "area": 0.02 * mesh["area"]} if expect.follows else {}
    for name in ("volume", "area", "euler", "components", "genus"):
        for words in expect.of(name):
            fault = compare(name, mesh.get(name, float("nan")), words, room.get(name, 0.0))
            if fault:
                yield fault
    for words in expect.of("bounds"):
        fault = compare_bounds(mesh["bounds"], words, tolerance if expect.follows else 0.0)
        if fault:
            yield fault


def check_scene(path, folder, said, follows):
    """Yields the faults of one scene; what the program said goes to the list `said`."""
    expect = Expectations(path, follows)
    fails = bool(expect.of("error"))
    out = ["-o", os.path.join(folder, "out.stl")] if fails else ["--stats"]
    result = cli.run(os.path.basename(path), *expect.how(), *out,
                     cwd=os.path.dirname(path))
    said.append(result.stderr.strip() or "(no message)")
    if not expect.values:
        yield "no //! expect line"
    yield from check_findings(result, expect)
    if "Sanitizer" in result.stderr or "runtime error" in result.stderr or result.returncode < 0:
        yield "crashed"
    if fails and result.returncode not in (1, 2):
        yield f"exit status {result.returncode}, expected a refusal"
    if fails and os.listdir(folder):
        yield "left a file"
    if fails and "hint:" not in result.stderr and "^" not in result.stderr:
        yield "shows neither a place nor a hint"
    if not fails and result.returncode != 0:
        yield f"exit status {result.returncode}"
    if not fails and result.returncode == 0:
        yield from check_mesh(json.loads(result.stdout), expect)


def check_and_quote(path, folder, follows):
    """The faults of one scene and, where there are any, what the program said."""
    said = []
    faults = list(check_scene(path, folder, said, follows))
    return faults + said if faults else []


def main():
    folder, follows = sys.argv[1], sys.argv[2:] == ["normal"]
    scenes = sorted(name for name in os.listdir(folder)) if os.path.isdir(folder) else []
    scenes = [name for name in scenes if name.endswith((".txt", ".scad"))]
    scenes = [name for name in scenes if not name.startswith("_")]  # parts of others
    if not scenes:
        print(f"no scenes in {folder}")
        return 77
    bad, skipped = 0, 0
    for name in scenes:
        lacks = Expectations(os.path.join(folder, name)).lacks()
        if lacks:
            print(f"skip {name}: no library has {', '.join(lacks)}")
            skipped += 1
            continue
        with tempfile.TemporaryDirectory() as place:
            faults = check_and_quote(os.path.abspath(os.path.join(folder, name)), place, follows)
        bad += bool(faults)
        print(f"{'FAIL' if faults else 'ok  '} {name}")
        for fault in faults:
            print("     " + fault.replace("\n", "\n     "))
    print(f"{len(scenes) - bad - skipped} of {len(scenes)} scenes as expected, {skipped} skipped")
    return 1 if bad else 77 if skipped == len(scenes) else 0


if __name__ == "__main__":
    sys.exit(main())
