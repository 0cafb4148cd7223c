#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts the report page's style and scripts into its HTML and prints the bytes as a C initialiser.

    embed.py page.html page.css view.js page.js

{{css}} and {{js}} are filled here; {{title}}, {{plain}} and {{data}} by csgmesh diff.
"""
import sys


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def main():
    html, css, *scripts = map(read, sys.argv[1:])
    page = html.replace("{{css}}", css).replace("{{js}}", "\n".join(scripts)).encode()
    for start in range(0, len(page), 20):
        print(",".join(map(str, page[start:start + 20])) + ",")


if __name__ == "__main__":
    main()
