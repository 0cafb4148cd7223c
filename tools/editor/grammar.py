#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes csgmesh.tmLanguage.json, the TextMate grammar of scenes, from the tables of the language; with
--check only compares.

Usage: grammar.py [--check]
"""
import json
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
OUT = os.path.join(HERE, "csgmesh.tmLanguage.json")
NAME = r"[A-Za-z0-9_]*[A-Za-z_][A-Za-z0-9_]*"
DEFINERS, CONSTANTS = {"module", "function"}, {"true", "false", "undef"}
READERS = {"include", "use"}


def rows(path, pattern):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        found = re.findall(pattern, re.sub(r"/\*.*?\*/", "", file.read(), flags=re.S))
    return list(dict.fromkeys(found))


def any_of(words):
    return "(?:" + "|".join(re.escape(w) for w in sorted(words, key=lambda w: (-len(w), w))) + ")"


def word(words):
    return r"(?<![\w$])" + any_of(words) + r"(?!\w)"


def pattern(scope, match, **captures):
    return {"name": scope + ".csgmesh", "match": match, **captures}


def captures(*scopes):
    return {str(i + 1): {"name": scope + ".csgmesh"} for i, scope in enumerate(scopes)}


def grammar():
    keywords = set(rows("src/text/tokens.def", r'CSG_KEYWORD\(\w+, "(\w+)"\)'))
    signs = rows("src/text/tokens.def", r'CSG_PUNCTUATION\(\w+, "([^"]+)"\)')
    functions = rows("src/lang/functions/functions.def", r"CSG_FUNCTION\((\w+),")
    modules = [m for m in rows("src/lang/modules/modules.def", r"CSG_(?:MODULE|CONTROL|ALIAS)\((\w+),") if m not in keywords]
    brackets = [s for s in signs if s in "()[]{},;"]
    operators = [s for s in signs if s not in brackets]
    control = keywords - DEFINERS - CONSTANTS - READERS
    strings = {"name": "string.quoted.double.csgmesh", "begin": '"', "end": '"',
               "patterns": [pattern("constant.character.escape",
                                    r"\\(?:[ntr\"\\]|x[0-9A-Fa-f]{2}|u[0-9A-Fa-f]{4}|U[0-9A-Fa-f]{6}"
                                    r"|u\{[0-9A-Fa-f]{1,6}\})")]}
    return {
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": "csgmesh", "scopeName": "source.csgmesh", "fileTypes": ["csgmesh", "scad"],
        "patterns": [
            {"name": "comment.block.csgmesh", "begin": r"/\*", "end": r"\*/"},
            pattern("comment.line.double-slash", r"//.*$"),
            {"match": r"(?<![\w$])(include|use)[ \t]*(<[^>\n]*>)",
             "captures": captures("keyword.control.import", "string.quoted.other")},
            strings,
            {"match": rf"(?<![\w$])(module|function)(?!\w)\s+({NAME})(?=\s*\()",
             "captures": captures("storage.type", "entity.name.function")},
            pattern("storage.type", word(DEFINERS)),
            pattern("constant.language", word(CONSTANTS | {"PI"})),
            pattern("keyword.control.import", word(READERS)),
            pattern("keyword.control", word(control)),
            pattern("constant.numeric",
                    r"(?<![\w$])(?:0[xX][0-9A-Fa-f]+|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)(?!\w)"),
            pattern("variable.parameter", rf"(?<![\w$]){NAME}(?=\s*=(?!=))"),
            pattern("variable.language", r"\$[A-Za-z0-9_]*"),
            pattern("support.function.module", word(modules) + r"(?=\s*\()"),
            pattern("support.function", word(functions) + r"(?=\s*\()"),
            pattern("entity.name.function.call", rf"(?<![\w$]){NAME}(?=\s*\()"),
            pattern("variable.other", rf"(?<![\w$]){NAME}"),
            pattern("keyword.operator", any_of(operators)),
            pattern("punctuation", any_of(brackets)),
        ],
    }


def main():
    text = json.dumps(grammar(), indent=2) + "\n"
    if sys.argv[1:] == ["--check"]:
        with open(OUT, encoding="utf-8") as file:
            if file.read() != text:
                sys.exit("tools/editor/csgmesh.tmLanguage.json is not up to date: run tools/editor/grammar.py")
        return
    with open(OUT, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
