#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Echo side by side with OpenSCAD: every FILE.scad here has FILE.echo, what OpenSCAD 2021.01 writes.

    compare_echo.py       csgmesh against the .echo files: the ECHO lines are equal, line for line, and
                          where OpenSCAD warns, csgmesh says something too (or is in SILENT)
    compare_echo.py --openscad the .echo files against the openscad that is installed; 77 where it is not
    compare_echo.py --write  makes the .echo files anew

Names of files restrict it to these.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "data" / "openscad" / "echo"
VERSION = "2021.01"
SKIPPED = 77
KINDS = re.compile(r"(ECHO|WARNING|ERROR|TRACE|DEPRECATED|UI-WARNING|FONT-WARNING|Can't parse file)\b")

# OpenSCAD warns, csgmesh has nothing to say, for a reason.
SILENT = {
    "assign_statement",         # assign() is deprecated there
    "compare_range_order",      # begin, end and sign of the step are allowed to disagree
    "range_elements",
    "scope_parameter_reassigned",
    "search_string_in_list",    # a search without a match is a result, not a mistake
    "undef_compare",            # where undef comes from has been told
}


def split_messages(text):
    """[(kind, text)]: a line that begins no message goes on with the one before (echo("a\\nb"))."""
    messages = []
    for line in text.split("\n"):
        kind = KINDS.match(line)
        if kind:
            messages.append([kind.group(1), line])
        elif messages:
            messages[-1][1] += "\n" + line
    return [(kind, text.rstrip("\n")) for kind, text in messages]


def run_openscad(scene):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.echo"
        subprocess.run(["openscad", "-o", str(out), scene.name], cwd=FOLDER, timeout=60,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return out.read_bytes().decode("utf-8", "surrogateescape")


def run_csgmesh(scene):
    """What it echoes, and how many other things it says."""
    done = subprocess.run([os.environ["CSGMESH"], "check", "--diagnostics=json", "--openscad-version", VERSION,
                           scene.name],
                          cwd=FOLDER, timeout=60, capture_output=True)
    echoes, findings = [], []
    for line in done.stderr.decode("utf-8", "surrogateescape").splitlines():
        one = json.loads(line)
        if "echo" in one:
            echoes.append(one["echo"])
        elif one.get("code", "W0390") != "W0390":  # notes of sums have none;  # most of these scenes have no solid
            findings.append(f"{one['code']} {one.get('line', 0)}: {one['message']}")
    return echoes, findings


def compare_csgmesh(scene):
    messages = split_messages(scene.with_suffix(".echo").read_bytes().decode("utf-8", "surrogateescape"))
    expected = [text for kind, text in messages if kind == "ECHO"]
    echoes, findings = run_csgmesh(scene)
    problems = [f"  line {i}: {a!r}\n    expected {b!r}"
                for i, (a, b) in enumerate(zip(echoes, expected), 1) if a != b]
    if len(echoes) != len(expected):
        problems.append(f"  {len(echoes)} echoes, expected {len(expected)}")
    warns = any(kind not in ("ECHO", "TRACE") for kind, _ in messages)
    if warns and not findings and scene.stem not in SILENT:
        problems.append("  OpenSCAD warns, csgmesh says nothing")
    if (not warns or findings) and scene.stem in SILENT:
        problems.append("  is in SILENT but need not be")
    return problems + (["  csgmesh says " + text for text in findings] if problems else [])


def compare_openscad(scene):
    golden = scene.with_suffix(".echo").read_bytes().decode("utf-8", "surrogateescape")
    found = run_openscad(scene)
    return [] if found == golden else [f"  openscad writes\n{found}\n  the file holds\n{golden}"]


def write_golden(scene):
    scene.with_suffix(".echo").write_bytes(run_openscad(scene).encode("utf-8", "surrogateescape"))
    return []


def is_installed():
    if not shutil.which("openscad"):
        print("skipped: there is no openscad here (Debian package openscad)")
        return False
    said = subprocess.run(["openscad", "--version"], capture_output=True, text=True)
    if VERSION not in said.stdout + said.stderr:
        print(f"skipped: this is {(said.stdout + said.stderr).strip()}, the files are of {VERSION}")
        return False
    return True


def main():
    arguments = sys.argv[1:]
    mode = arguments.pop(0) if arguments[:1] in (["--openscad"], ["--write"]) else "--csgmesh"
    if mode != "--csgmesh" and not is_installed():
        return SKIPPED
    scenes = [FOLDER / name for name in arguments] or sorted(FOLDER.glob("*.scad"))
    check = {"--csgmesh": compare_csgmesh, "--openscad": compare_openscad, "--write": write_golden}[mode]
    wrong = 0
    for scene in scenes:
        problems = check(scene)
        wrong += bool(problems)
        if problems:
            print(scene.name, *problems[:8], sep="\n")
        if wrong == 20:
            break
    print(f"{len(scenes)} files, {wrong} differ")
    return 1 if wrong or len(scenes) < (1 if arguments else 250) else 0


if __name__ == "__main__":
    sys.exit(main())
