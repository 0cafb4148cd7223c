#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Keeps a picture under every example of the language manual.

    python3 tools/manual/pictures.py CSGMESH    makes what is missing, drops what is left over
    python3 tools/manual/pictures.py --check    exit status 1 when that would change something

A ```csgmesh block of scenes/README.md is followed by a line ![...](../docs/pictures/manual/NAME.png), where NAME is the head of the
SHA-256 of all blocks up to it that it may include, and its own text: a picture of another text has another name. Blocks that are only
saved (file=) have none. Needs node and chromium (tools/view).
"""
import hashlib
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
MANUAL = os.path.join(ROOT, "scenes", "README.md")
FOLDER = os.path.join(ROOT, "docs", "pictures", "manual")
PICTURE = r"\n!\[[^\]]*\]\(\.\./docs/pictures/manual/[^)]*\)\n"
BLOCK = re.compile(r"^```csgmesh(?: file=(\S+))?\n(.*?)^```\n(" + PICTURE + ")?", re.M | re.S)


def name_of(saved, text):
    whole = "".join(saved.values()) + text
    return hashlib.sha256(whole.encode()).hexdigest()[:12] + ".png"


def renew(text):
    """The manual with the right picture under each block, and {picture: (files, scene)}."""
    saved, wanted, out, at = {}, {}, [], 0
    for block in BLOCK.finditer(text):
        file, scene = block.group(1), block.group(2)
        out.append(text[at:block.start()])
        at = block.end()
        fence = f"```csgmesh{' file=' + file if file else ''}\n{scene}```\n"
        if file:
            saved[file] = scene
            out.append(fence)
            continue
        name = name_of(saved, scene)
        wanted[name] = (dict(saved), scene)
        out.append(f"{fence}\n![The example above](../docs/pictures/manual/{name})\n")
    out.append(text[at:])
    return "".join(out), wanted


def make(program, name, files, scene):
    with tempfile.TemporaryDirectory() as folder:
        for file, text in files.items():
            with open(os.path.join(folder, file), "w", encoding="utf-8") as out:
                out.write(text)
        path = os.path.join(folder, "scene.txt")
        with open(path, "w", encoding="utf-8") as out:
            out.write(scene)
        mesh = os.path.join(folder, "scene.glb")
        subprocess.run([program, path, "-o", mesh, "-r", "300", "-q"], check=True)
        subprocess.run(["node", os.path.join(ROOT, "tools", "view", "view.js"), mesh, "--size", "480x300",
                        "--zoom", "1.2", "-o", os.path.join(FOLDER, name)], check=True)


def main():
    with open(MANUAL, encoding="utf-8") as file:
        old = file.read()
    new, wanted = renew(old)
    have = set(os.listdir(FOLDER)) if os.path.isdir(FOLDER) else set()
    if "--check" in sys.argv[1:]:
        for name in sorted(have ^ set(wanted)):
            print(f"docs/pictures/manual/{name} is {'left over' if name in have else 'missing'}")
        if new != old:
            print("scenes/README.md shows other pictures than those of its examples")
        return int(new != old or have != set(wanted))
    os.makedirs(FOLDER, exist_ok=True)
    for name in have - set(wanted):
        os.remove(os.path.join(FOLDER, name))
    for name, (files, scene) in wanted.items():
        if name not in have:
            make(sys.argv[1], name, files, scene)
    if new != old:
        with open(MANUAL, "w", encoding="utf-8") as file:
            file.write(new)
    return 0


if __name__ == "__main__":
    sys.exit(main())
