#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts style, scripts and parts of its body into a page and prints the bytes as a C initialiser.

    embed.py page.html [PART.html...] page.css... view.js page.js...

{{css}}, {{js}} and {{PART.html}} are filled here; {{title}}, {{plain}} and {{data}} of the report by csgmesh diff.
"""
import os
import sys


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read().rstrip("\n")


def fill(frame, *others):
    """The text of the page that is made of these files."""
    page, texts = read(frame), {".css": [], ".js": []}
    for path in others:
        kind = os.path.splitext(path)[1]
        if kind == ".html":
            page = page.replace("{{" + os.path.basename(path) + "}}", read(path))
        else:
            texts[kind].append(read(path))
    return page.replace("{{css}}", "\n".join(texts[".css"])).replace("{{js}}", "\n".join(texts[".js"])) + "\n"


def main():
    page = fill(*sys.argv[1:]).encode()
    for start in range(0, len(page), 20):
        print(",".join(map(str, page[start:start + 20])) + ",")


if __name__ == "__main__":
    main()
