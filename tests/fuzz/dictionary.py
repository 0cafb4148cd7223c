#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the fuzzers' dictionary from the tables of the language; with --check only compares.

Usage: dictionary.py [--check]
"""
import os
import re
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
OUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "scene.dict")
# (table, row, number of the column with the word)
TABLES = [("src/text/tokens.def", r'CSG_(?:KEYWORD|PUNCTUATION)\(\w+, "([^"]+)"\)'),
          ("src/lang/functions/functions.def", r"CSG_FUNCTION\((\w+),"),
          ("src/lang/modules/modules.def", r"CSG_(?:MODULE|CONTROL)\((\w+),"),
          ("src/lang/modules/modules.def", r"CSG_PARAMETER\(\w+, ([\w$]+),"),
          ("src/lang/modules/modules.def", r"CSG_ALIAS\((\w+),"),
          ("src/lang/evaluate/unsupported_modules.def", r"CSG_UNSUPPORTED\((\w+),")]
# What no table names: special variables, odd numbers, escapes, the separator of files (files.c).
OTHERS = ["$fn", "$fa", "$fs", "$t", "$preview", "$children", "$parent_modules", "PI", "1e999", "-0",
          "0x1F", "1e-320", "4294967296", "9007199254740993", "\\u{1F600}", "\\x41", "\\n", "/*", "*/",
          "//", "include <a>", "use <b>", "\x1c", "\u00e9", "\ufeff", "[0:1:2]", "[1,2,3]", "[[1,2],[3,4]]",
          "function(x) x", "module m(){", "let(a=1)", "\"s\"", ".x", "[0]", "<a>", "$x="]


def words():
    found = []
    for path, pattern in TABLES:
        full = os.path.join(ROOT, path)
        if os.path.exists(full):
            with open(full, encoding="utf-8") as file:
                found += re.findall(pattern, re.sub(r"/\*.*?\*/", "", file.read(), flags=re.S))
    return list(dict.fromkeys(found + OTHERS))


def quoted(word):
    return '"' + "".join(chr(b) if 0x20 <= b < 0x7F and chr(b) not in '"\\' else f"\\x{b:02X}"
                         for b in word.encode()) + '"'


def main():
    text = "# Made by dictionary.py from the tables of the language.\n" + "".join(
        quoted(word) + "\n" for word in words())
    if sys.argv[1:] == ["--check"]:
        with open(OUT, encoding="utf-8") as file:
            if file.read() != text:
                sys.exit("tests/fuzz/scene.dict is not up to date: run tests/fuzz/dictionary.py")
        return
    with open(OUT, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
