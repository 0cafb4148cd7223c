# SPDX-License-Identifier: MIT
"""Trees that `openscad -o x.csg x.scad` wrote are scenes, of the same solid as x.scad.

Volume, bounds and topology of both meshes agree (the trees have six digits); a tree warns of nothing
that its source does not warn of. --openscad: the trees are what the installed OpenSCAD writes (exit
status 77, a skip, where none is installed).
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "openscad", "csg")
PROGRAM = os.environ.get("CSGMESH")
NOT_YET = "E0207"


def names():
    return sorted(name[:-5] for name in os.listdir(HERE) if name.endswith(".scad"))


def facts(name):
    """(mesh facts or None, codes of findings, what was said)"""
    result = subprocess.run([PROGRAM, "info", "--json", "-r", "32", os.path.join(HERE, name)],
                            capture_output=True, timeout=300, check=False)
    said = result.stderr.decode("utf-8", "replace")
    codes = set(re.findall(r"(?:error|warning) ([EW]\d{4}):", said))
    return json.loads(result.stdout)["mesh"] if result.returncode == 0 else None, codes, said


def close(a, b, scale):
    return abs(a - b) <= 1e-3 * scale


def compare(name):
    """Yields the faults of one pair."""
    source, source_codes, source_said = facts(name + ".scad")
    tree, tree_codes, said = facts(name + ".csg")
    if not source or not tree:
        yield f"not meshed\n{source_said}{said}"
        return
    for code in sorted(tree_codes - source_codes):
        yield f"the tree gets {code}:\n{said}"
    if not close(source["volume"], tree["volume"], source["volume"]):
        yield f"volume {tree['volume']} of the tree, {source['volume']} of the source"
    size = max(b - a for a, b in zip(*source["bounds"]))
    for a, b in zip(sum(source["bounds"], []), sum(tree["bounds"], [])):
        if not close(a, b, size):
            yield f"bounds {tree['bounds']} of the tree, {source['bounds']} of the source"
            break
    for key in ("euler", "components", "boundary_edges"):
        if source[key] != tree[key]:
            yield f"{key} {tree[key]} of the tree, {source[key]} of the source"


def round_trip(name):
    """The tree's dump parses back to the same dump."""
    path, first = os.path.join(HERE, name + ".csg"), None
    for text in (None, "again"):
        result = subprocess.run([PROGRAM, "dump", "--scene", "-q", path if not text else "-"],
                                input=first, capture_output=True, timeout=300, check=False)
        if result.returncode != 0:
            yield f"dump: {result.stderr.decode('utf-8', 'replace')}"
            return
        if text and result.stdout != first:
            yield "the dump parses back to another tree"
        first = result.stdout


def check_pairs():
    bad = 0
    for name in names():
        faults = list(compare(name)) or list(round_trip(name))
        if any(NOT_YET in fault for fault in faults):
            print(f"skip {name}: a shape that this version does not have")
            continue
        bad += bool(faults)
        print(f"{'FAIL' if faults else 'ok  '} {name}")
        for fault in faults:
            print("     " + fault.strip().replace("\n", "\n     "))
    return 1 if bad or not names() else 0


def check_trees():
    """Are the committed trees what OpenSCAD makes of the sources?"""
    openscad = shutil.which("openscad")
    if not openscad:
        print("openscad is not installed: skipped")
        return 77
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in names():
            out = os.path.join(folder, name + ".csg")
            subprocess.run([openscad, "-q", "-o", out, os.path.join(HERE, name + ".scad")], timeout=120,
                           check=True)
            with open(out, encoding="utf-8") as made, open(os.path.join(HERE, name + ".csg"),
                                                           encoding="utf-8") as kept:
                same = made.read() == kept.read()
            bad += not same
            print(f"{'ok  ' if same else 'FAIL'} {name}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(check_trees() if "--openscad" in sys.argv else check_pairs())
