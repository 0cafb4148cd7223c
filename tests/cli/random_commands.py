# SPDX-License-Identifier: MIT
"""Random command lines: options of each command as its help lists them, with values as they should be and as they should
not, over files that are whole, broken, missing and named twice.

Usage: random_commands.py COUNT SEED

Each must end by itself with status 0, 1 or 2, say something when it is 2, leave what it reads as it was and no unfinished
file behind; a mesh or picture that failed has no output, one that was made has all of them.
"""
import os
import random
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import cli

COMMANDS = ["mesh", "render", "batch", "diff", "convert", "check", "info", "eval", "dump", "params", "format", "openscad",
            "deps", "completion", "man", "version", "help", "lsp"]
# They wait for somebody, or for ever.
LEFT_OUT = {"--watch", "--help"}
LONGEST_S = 120  # only a hang takes so long: all have --timeout and small meshes
MESHES = ["c.stl", "d.glb", "e.ply", "f.obj", "broken.glb"]
SCENES = ["a.txt", "b.scad", "bad.txt", "empty.txt", "flat.txt", "parts.txt"]
OTHERS = ["missing.txt", "missing.stl", "dir", "params.json", "manifest.json", "-", "", "\udcff.txt"]
OUTPUTS = ["out.stl", "out.glb", "out.gltf", "out.ply", "out.obj", "out.off", "out.3mf", "out.amf", "out.drc", "out.svg",
           "out.dxf", "out.pdf", "out.png", "out.ppm", "out", "out.xyz", "dir/out.ply", "none/out.ply", "-"]
ODD = ["", "-1", "0", "nan", "inf", "1e999", "%s%n", "a" * 5000, "\udcff", "1,2", "=", "--", "x=1", "99999999999999999999", "0x10"]
BALL = "size = 5; // of the ball\nunion(blend = 1) { sphere(size); cube([6, 2, 2]); }\n"


def fill(folder):
    """What the commands read; all of it is small."""
    texts = {
        "a.txt": BALL, "b.scad": "difference() { cube(4); translate([1, 1, -1]) cylinder(r = 1, h = 9); }\n",
        "bad.txt": "sphere(;\n", "empty.txt": "", "flat.txt": "square([4, 3]);\n",
        "parts.txt": 'color("red") part("one") cube(2); part("two") translate([4, 0, 0]) sphere(1);\n',
        "params.json": '{"parameterSets": {"small": {"size": "2"}}, "fileFormatVersion": "1"}\n',
        "manifest.json": '{"jobs": [{"scene": "a.txt", "output": "m.stl", "options": {"resolution": 8}}]}\n'}
    for name, text in texts.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    os.mkdir(os.path.join(folder, "dir"))
    for name in MESHES[:-1]:
        subprocess.run([cli.PROGRAM, "a.txt", "-r", "8", "-q", "-o", name], cwd=folder, check=True)
    with open(os.path.join(folder, "d.glb"), "rb") as whole, open(os.path.join(folder, "broken.glb"), "wb") as file:
        file.write(whole.read()[:-40])


def options_of(command):
    """(name, what its value is called or None) of each option in a command's help."""
    text = subprocess.run([cli.PROGRAM, "help", command], capture_output=True, text=True, check=True).stdout
    rows = re.findall(r"^  (?:-\w, |    )(--[\w-]+)(\[=\w+\]| [^a-z ]\S*| \S+\|\S+| \d+\.\.\d+)?(?=  |$| [a-z]|\n)", text, re.M)
    return [(name, value.strip() or None) for name, value in rows if name not in LEFT_OUT]


def value_of(rng, kind):
    """One as the kind of value wants it, mostly."""
    if rng.random() < 0.06:
        return rng.choice(ODD)
    if "|" in kind and not re.search("[A-Z]", kind):
        return rng.choice(kind.split("|"))
    if re.fullmatch(r"\d+\.\.\d+", kind):
        return str(rng.randint(*map(int, kind.split(".."))))
    number = lambda: f"{rng.uniform(-9, 9):.2f}"
    return {
        "FILE": lambda: rng.choice(OUTPUTS + ["s.json", "params.json", "a.txt", "out.html", "out.xml"]),
        "DIR": lambda: rng.choice(["dir", ".", "new", "/nonexistent", ""]),
        "SIZE": lambda: rng.choice(["300M", "1G", "20M", "1K"]), "SECONDS": lambda: rng.choice(["5", "0.01"]),
        "NAME=EXPR": lambda: rng.choice(["size=3", "size=", "nothing=1", 'size="x"', "size=[1", "=3"]),
        "KEY=VALUE": lambda: rng.choice(["title=A <&> B", "x=", "=y", "title"]),
        "FORMAT": lambda: rng.choice(["stl", "ply", "glb", "3mf", "png", "svg", "nope"]),
        "X,Y,Z": lambda: ",".join(number() for _ in range(rng.choice([3, 3, 3, 2]))),
        "X0,Y0,Z0,X1,Y1,Z1": lambda: ",".join(["-3", "-3", "-3", "3", "3", rng.choice(["3", "-4"])]),
        "WxH": lambda: rng.choice(["32x24", "0x9", "16x16"]), "N": lambda: str(rng.choice([0, 1, 2, 3, 8, 12])),
        "NAME": lambda: rng.choice(["small", "front", "none", "fast-csg"]), "AXIS=AT": lambda: rng.choice(["z=1", "x=50%", "q=1"]),
        "COLOR": lambda: rng.choice(["red", "#00ff0080", "nocolor"]), "PATTERN": lambda: rng.choice(["{stem}-{set}", "{", "x"]),
    }.get(kind, lambda: rng.choice([f"{rng.uniform(0, 2):.3f}", "50%", "2", "auto", "volume"]))()


def random_line(rng, command, options):
    """The words behind the program's name, and those among them that it is to read."""
    read, words = [], [command] if command != "mesh" or rng.random() < 0.5 else []
    pools = {"diff": MESHES + SCENES, "convert": MESHES, "info": MESHES + SCENES, "render": MESHES + SCENES}
    pool = pools.get(command, SCENES)
    operands = {"diff": 2, "completion": 1, "version": 0, "lsp": 0, "man": rng.randint(0, 1), "help": rng.randint(0, 1),
                "batch": rng.randint(1, 3), "convert": rng.randint(1, 2)}.get(command, 1)
    if rng.random() < 0.06:
        operands += rng.choice([-1, 1])
    for _ in range(operands):
        if command in ("completion", "man", "help"):
            words.append(rng.choice(["bash", "zsh", "fish"] + COMMANDS + ODD[:3]))
        else:
            read.append(rng.choice(pool) if rng.random() < 0.93 else rng.choice(OTHERS))
            words.append(read[-1])
    if command in ("mesh", "convert", "render", "openscad") and rng.random() < 0.9:
        for _ in range(rng.choice([1, 1, 1, 2])):
            words += ["-o", rng.choice(OUTPUTS) if rng.random() < 0.95 else rng.choice(SCENES + MESHES)]
    if command == "batch" and rng.random() < 0.9:
        words += ["-d", rng.choice(["dir", "new", "."])]
    for name, kind in rng.sample(options, min(len(options), rng.choice([0, 1, 1, 2, 2, 3, 5]))):
        if kind is None or kind.startswith("["):
            words.append(name + (("=" + rng.choice(["s.json", "out.stl", ""])) if kind and rng.random() < 0.5 else ""))
        else:
            joined = rng.random() < 0.4
            words += [f"{name}={value_of(rng, kind)}"] if joined else [name, value_of(rng, kind)]
    if rng.random() < 0.05:
        words.insert(rng.randint(0, len(words)), rng.choice(["--nope", "-Z", "--", "-", "--o", "-o"]))
    known = {name for name, _ in options}
    small = [("--resolution", "10"), ("--size", "24x24"), ("--max-memory", "400M"), ("--timeout", "20")]
    words += [word for name, value in small if name in known and not any(w.startswith(name) for w in words)
                    and not (name == "--resolution" and rng.random() < 0.3) for word in (name, value)]
    return words, read


def contents(folder):
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


def faults_of(folder, words, read, before):
    """What is wrong with this run, and its status."""
    try:
        done = subprocess.run([cli.PROGRAM, *words], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, check=False,
                              timeout=LONGEST_S)
    except subprocess.TimeoutExpired:
        return ["it does not end"], None
    after, faults = contents(folder), []
    said = done.stderr.decode(errors="replace")
    if done.returncode not in (0, 1, 2):
        faults.append(f"status {done.returncode}: {said[-2000:]}")
    if re.search(r"Sanitizer|runtime error:|Assertion", said):
        faults.append(said[-3000:])
    if done.returncode == 2 and not said:
        faults.append("trouble without a word")
    may_change = "format" in words or any(w.startswith("--update") for w in words)
    for name, content in before.items():
        if after.get(name) != content and name in read and not may_change:
            faults.append(f"{name} has changed")
    faults += [f"{name} is left behind" for name in after if name not in before and ".tmp" in name]
    made = [words[i + 1] for i, word in enumerate(words[:-1]) if word == "-o"]
    if words[:1] in (["mesh"], ["render"]) and done.returncode == 2 and "--stats" not in " ".join(words):
        faults += [f"{name} was written though it failed" for name in made if name in after and name not in before]
    if words[:1] in (["mesh"], ["render"]) and done.returncode == 0 and not {"--help", "--version", "--turntable"} & set(words):
        faults += [f"{name} was not written" for name in made if name != "-" and not any(key.startswith(name[:3]) for key in after)]
    return faults, done.returncode


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    options = {command: options_of(command) for command in COMMANDS}
    bad, statuses = 0, {}
    with tempfile.TemporaryDirectory() as top:
        whole = os.path.join(top, "whole")
        os.mkdir(whole)
        fill(whole)
        before = contents(whole)
        for i in range(count):
            rng = random.Random(f"{seed} {i}")
            command = rng.choice(["mesh"] * 4 + ["render", "diff", "batch", "convert"] * 2 + COMMANDS)
            words, read = random_line(rng, command, options[command])
            folder = os.path.join(top, "now")
            shutil.copytree(whole, folder)
            faults, status = faults_of(folder, words, read, before)
            statuses[status] = statuses.get(status, 0) + 1
            shutil.rmtree(folder)
            bad += bool(faults)
            if faults:
                print(f"command {i} of seed {seed}: {shlex.join(words)}\n  " + "\n  ".join(faults))
    print(f"{count} command lines, {bad} at fault; " + ", ".join(f"status {status}: {n}" for status, n in sorted(statuses.items(), key=str)))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
