# SPDX-License-Identifier: MIT
"""The comments of forms.scad mean what OpenSCAD 2021.01 takes them for.

forms.ast is its own tree of the file, with an annotation line for each group, description and hint
that it found; `csgmesh params` must list the same. Not compared: comments on one line without
brackets, which there begin a group without a name and nothing here. --openscad: forms.ast is what
the installed OpenSCAD writes (exit status 77, a skip, where none is installed).
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "openscad", "customizer")
SCENE, TREE = os.path.join(HERE, "forms.scad"), os.path.join(HERE, "forms.ast")


def annotated(text):
    """Yields (name, {annotation: value}) of each assignment that OpenSCAD takes for a parameter."""
    notes = {}
    for line in text.splitlines():
        note = re.fullmatch(r"//(Group|Description|Parameter)\((.*)\)", line)
        assignment = re.match(r"(\$?\w+) = ", line)
        if note:
            notes[note.group(1)] = note.group(2)
        elif assignment and "Parameter" in notes:
            yield assignment.group(1), notes
            notes = {}
        else:
            notes = {}


def text_of(value):
    return value if isinstance(value, str) else f"{value:g}"


def put_choices(wanted, values, is_string):
    pairs = [value if isinstance(value, list) else [value, value] for value in values]
    wanted["options"] = [{"name": text_of(label), "value": text_of(value) if is_string else value}
                         for value, label in pairs]


def expected(param, notes):
    """What the hint says of a parameter of this kind, in csgmesh's words."""
    wanted = {"group": json.loads(notes["Group"]) if "Group" in notes else "Parameters"}
    if "Description" in notes:
        wanted["caption"] = json.loads(notes["Description"])
    hint, is_string = notes["Parameter"], param["type"] == "string"
    is_vector = isinstance(param["initial"], list)
    numbers = re.fullmatch(r"\[([-\d.e+]+) : ([-\d.e+]+)(?: : ([-\d.e+]+))?\]", hint)
    if param["type"] == "boolean":
        return wanted
    if numbers:
        found = [float(number) for number in numbers.groups() if number]
        if not is_string:
            wanted.update(min=found[0], max=found[-1])
            if len(found) == 3:
                wanted["step"] = found[1]
        return wanted
    value = json.loads(hint)
    if isinstance(value, list) and len(value) == 1 and not isinstance(value[0], (str, list)):
        wanted["maxLength" if is_string else "max"] = value[0]
    elif isinstance(value, list) and not is_vector:
        put_choices(wanted, value, is_string)
    elif not isinstance(value, (str, list)):
        wanted["maxLength" if is_string else "step"] = value
    return wanted


def check_forms():
    result = subprocess.run([os.environ["CSGMESH"], "params", "-q", SCENE], capture_output=True,
                            timeout=60, check=True)
    listed = {param["name"]: param for param in json.loads(result.stdout)["parameters"]}
    bad, count = 0, 0
    with open(TREE, encoding="utf-8") as file:
        for name, notes in annotated(file.read()):
            param = listed.pop(name, None)
            if notes.get("Group") == '"Hidden"':
                bad += param is not None
                continue
            count += 1
            found = {key: value for key, value in (param or {}).items()
                     if key not in ("name", "type", "initial", "line")}
            wanted = expected(param, notes) if param else "a parameter"
            if found != wanted:
                bad += 1
                print(f"FAIL {name}: {found}\n     OpenSCAD: {wanted}")
    for name in listed:
        bad += 1
        print(f"FAIL {name}: not a parameter in OpenSCAD")
    print(f"{count} parameters, {bad} faults")
    return 1 if bad or count < 50 else 0


def check_tree():
    openscad = shutil.which("openscad")
    if not openscad:
        print("openscad is not installed: skipped")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "forms.ast")
        subprocess.run([openscad, "-o", out, SCENE], capture_output=True, timeout=60, check=True)
        with open(out, encoding="utf-8") as made, open(TREE, encoding="utf-8") as kept:
            return 0 if made.read() == kept.read() else 1


if __name__ == "__main__":
    sys.exit(check_tree() if "--openscad" in sys.argv else check_forms())
