#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""page.py [FOLDER] [--bare]: the page for browsers, FOLDER/page/index.html; without FOLDER in build-web.

The module of build.py, a font, scripts, style and scenes are in this one file, so it works from a server and from a
folder. What comes from npm is named in page/package-lock.json. --bare: a module without optional libraries, and no font.
Exit status: 0; 1 where the build fails; 77 where a tool is missing, which is named.
"""
import base64
import gzip
import json
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
VIEW = os.path.join(ROOT, "tools", "csgmesh", "view", "page")
sys.path.insert(0, os.path.join(ROOT, "tools", "csgmesh", "page"))
import build  # pylint: disable=wrong-import-position
import libraries  # pylint: disable=wrong-import-position
import embed  # pylint: disable=wrong-import-position

# Scenes of the menu; what else is in their folders may be included.
GROUPS = [("Tour", "tour"), ("Parts", "parts"), ("Models", "models"), ("Papers", "papers")]


def install(place):
    """The packages of npm, once for each lock file."""
    lock, done = os.path.join(HERE, "page", "package-lock.json"), os.path.join(place, "installed.json")
    os.makedirs(place, exist_ok=True)
    wanted = embed.read(lock)
    if os.path.exists(done) and embed.read(done) == wanted:
        return
    if not shutil.which("npm"):
        build.give_up("npm is not there")
    for name in ("package.json", "package-lock.json"):
        shutil.copy(os.path.join(HERE, "page", name), place)
    run = subprocess.run(["npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts", "--prefix", place], capture_output=True, text=True,
                         check=False)
    if run.returncode:
        build.give_up("npm cannot install what the page needs: " + (run.stderr.strip().splitlines() or ["no reason given"])[-1])
    with open(done, "w", encoding="utf-8") as file:
        file.write(wanted)


def bundle(place, entry, target, *options):
    os.environ["NODE_PATH"] = os.path.join(place, "node_modules")
    libraries.run([os.path.join(place, "node_modules", ".bin", "esbuild"), os.path.join(HERE, "page", entry), "--bundle", "--minify",
               "--format=iife", "--target=es2022", "--log-level=warning", "--legal-comments=eof", f"--outfile={target}", *options])


def packed(data):
    """As the page unpacks it."""
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode()


def title_of(name):
    words = os.path.splitext(name)[0].replace("_", " ").replace("-", " ")
    return words[0].upper() + words[1:]


def read_scene(path):
    """Without what its test expects of it, at the head."""
    return re.sub(r"\A(?://!.*\n)+(?://\n)*", "", embed.read(path)) + "\n"


def read_scenes():
    scenes, groups = [], []
    for label, folder in GROUPS:
        top = os.path.join(ROOT, "scenes", folder)
        for path, folders, names in os.walk(top):
            folders.sort()
            scenes += [[os.path.relpath(os.path.join(path, name), ROOT), read_scene(os.path.join(path, name))]
                       for name in sorted(names) if name.endswith(".txt")]
        groups.append([label, [[f"scenes/{folder}/{name}", title_of(name)] for name in sorted(os.listdir(top)) if name.endswith(".txt")]])
    return scenes, groups


def read_bytes(path):
    with open(path, "rb") as file:
        return file.read()


def make(place, module, bare):
    """place/page/index.html."""
    npm, page = os.path.join(place, "npm"), os.path.join(place, "page")
    install(npm)
    os.makedirs(page, exist_ok=True)
    worker, script = os.path.join(npm, "worker.txt"), os.path.join(npm, "main.js")
    bundle(npm, "worker.js", worker)
    bundle(npm, "main.js", script, f"--alias:worker-source={worker}", "--loader:.txt=text")
    scenes, groups = read_scenes()
    font, licences = (None, "") if bare else libraries.assets(place)
    data = {"scenes": scenes, "groups": groups, "font": libraries.FONT_PATH}
    parts = [os.path.join(VIEW, name) for name in ("stage.html", "scene.html", "page.css")]
    scripts = [os.path.join(ROOT, "tools", "csgmesh", "page", "view.js")] + [os.path.join(VIEW, name) for name in ("solid.js", "stage.js", "scene.js")]
    text = embed.fill(os.path.join(HERE, "page", "page.html"), *parts, os.path.join(HERE, "page", "page.css"), *scripts, script)
    for name, content in (("module", read_bytes(module)), ("font", read_bytes(font) if font else b""), ("licences", licences.encode())):
        text = text.replace("{{" + name + "}}", packed(content))
    text = text.replace("{{data}}", json.dumps(data, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/"))
    target = os.path.join(page, "index.html")
    with open(target, "w", encoding="utf-8") as file:
        file.write(text)
    return target


def main(place, bare):
    module = build.main(place, bare)
    print(make(os.path.abspath(place), module, bare))


if __name__ == "__main__":
    main(*build.read_arguments(__doc__))
