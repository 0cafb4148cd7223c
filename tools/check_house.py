#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""House rules a machine can see: SPDX lines, files of at most 700 lines, functions of at most 80; a type that a header
declares has a name of its own; static functions are named by what they do; paths that are named in pages and comments
exist; no function of C's mathematical library whose last bits differ between libraries is called in src/.

With --format: clang-format agrees with every C file (exit 77, a skip, where version 14 is not there).
"""
import os
import re
import shutil
import subprocess
import sys

FILE_LINES, FUNCTION_LINES = 700, 80
FOLDERS = ["src", "include", "tools", "tests", "docs", ".ci"]
SKIPPED = {"node_modules", "__pycache__"}
CODE = (".c", ".h", ".cc")
MARKED = CODE + (".def", ".py", ".sh", ".js", ".mjs", "meson.build")

# file: why it may be longer.
LONG_FILES = {os.path.join("include", "csgmesh", "csgmesh.h"): "the whole public interface, in one place"}

# (file, function): why it may be longer.
LONG_FUNCTIONS = {}

# What such a function runs, puts or joins is what its name should say.
SAYS_NOTHING = {"run", "put", "join", "push", "finish"}
NAMED = ("src/", "tools/csgmesh/", "tests/")
# Types of headers that only kernels include, each in a file of its own: they are named as a .c names its own.
SHARED_TYPES = {"curve", "range"}


def files(root):
    for folder in FOLDERS:
        for place, folders, names in os.walk(os.path.join(root, folder)):
            folders[:] = sorted(set(folders) - SKIPPED)
            for name in sorted(names):
                yield os.path.relpath(os.path.join(place, name), root)


def is_script(path):
    with open(path, "rb") as file:
        return file.read(2) == b"#!"


def functions(lines):
    """(name, first line, length) of each function: its body opens with a brace in column one."""
    for number, line in enumerate(lines):
        if line != "{":
            continue
        first = number
        while first > 0 and lines[first - 1].strip() and not lines[first - 1].rstrip().endswith(
                ("*/", ";", "}")) and not lines[first - 1].startswith("#"):
            first -= 1
        end = next((i for i in range(number, len(lines)) if lines[i].startswith("}")), len(lines))
        name = re.search(r"(\w+)\(", " ".join(lines[first:number]))
        yield name.group(1) if name else "?", first + 1, end - first + 1


def defined_types(text):
    """Names of the types that a C file defines: struct, enum and union tags with a body, typedefs of anything."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    yield from re.findall(r"^\}\s*(\w+);", text, re.M)
    yield from re.findall(r"^(?:typedef\s+)?(?:struct|enum|union)\s+(\w+)[^;{()]*\{", text, re.M)
    for line, name in re.findall(r"^(typedef\s+[^{;()]*?\b(\w+)\s*(?:\[[^\]]*\])?;)", text, re.M):
        if not re.match(rf"typedef\s+(?:struct|enum|union)\s+{name}\s+{name};", line):
            yield name


def check_types(root):
    """One name, one type: what a header of src/ declares is declared nowhere else, in no other .c either."""
    where = {}
    for path in files(root):
        if path.startswith("src" + os.sep) and path.endswith(CODE):
            with open(os.path.join(root, path), encoding="utf-8") as file:
                for name in set(defined_types(file.read())):
                    where.setdefault(name, []).append(path)
    for name, paths in sorted(where.items()):
        headers = [path for path in paths if path.endswith(".h")]
        if headers and len(paths) > 1 and name not in SHARED_TYPES:
            yield headers[0], 1, f"the type {name} is defined in " + ", ".join(sorted(paths))


# These are rounded otherwise by every C library; the file has ours, which are the same everywhere.
ROUNDED_OTHERWISE = re.compile(r"(?<![\w.>])(?:std::)?((?:a?(?:sin|cos|tan)h?|sincos|atan2|hypot|pow|cbrt|exp|exp2|exp10|expm1|log|log2|"
                               r"log10|log1p|erf|erfc|tgamma|lgamma)[fl]?)\s*\(")
ELEMENTARY = os.path.join("src", "base", "elementary")


def check_mathematics(path, text):
    """(line, fault) of each call; comments and texts may name them."""
    if not path.startswith("src" + os.sep) or not path.endswith(CODE) or path.startswith(ELEMENTARY):
        return
    code = re.sub(r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'",
                  lambda match: re.sub(r"[^\n]", " ", match.group()), text, flags=re.S)
    for match in ROUNDED_OTHERWISE.finditer(code):
        yield code.count("\n", 0, match.start()) + 1, f"{match.group(1)}() has other bits in other C libraries: base/elementary.h"


def check_file(root, path):
    full = os.path.join(root, path)
    if not (path.endswith(MARKED) or is_script(full)):
        return
    with open(full, encoding="utf-8") as file:
        lines = file.read().split("\n")
    if not any("SPDX-License-Identifier: MIT" in line for line in lines[:3]):
        yield 1, "no SPDX line at its head"
    if len(lines) - 1 > FILE_LINES and path not in LONG_FILES:
        yield FILE_LINES, f"{len(lines) - 1} lines; {FILE_LINES} is the most: split it by meaning"
    yield from check_mathematics(path, "\n".join(lines))
    if path.endswith(CODE):
        for name, first, length in functions(lines):
            if length > FUNCTION_LINES and (path, name) not in LONG_FUNCTIONS:
                yield first, f"{name} has {length} lines; {FUNCTION_LINES} is the most"
            if name in SAYS_NOTHING and lines[first - 1].startswith("static") and path.startswith(NAMED):
                yield first, f"a static function called {name}: say what"


# A path from the root, or one of a source file from src, tests or tools/csgmesh, as pages and comments name them.
PATH = re.compile(r"(?<![\w/.$*{}<>~@-])((?:src|include|scenes|tests|tools|docs)/[\w./*{},-]*\w|"
                  r"[a-z_]+(?:/[a-z_]+)*/[\w-]+\.(?:c|h|cc|def))(?![\w*{<(/])")
PAGES = (".md", ".txt", ".def") + CODE + (".py", ".sh", "meson.build")
TEXT_ONLY = (".md", ".txt")  # the whole file is read; of code, comments and doc strings only
# These tell of what was, as docs/decisions do, or are made to name what is not there.
WITHOUT_PATHS = {"CHANGELOG.md", "tests/bench/log.md", "tests/bench/results.md", "tests/house/test_checks.py"}


def remarks(path, text):
    """What is written for readers: pages as a whole, of code the comments, doc strings and the heads of scripts."""
    if path.endswith(TEXT_ONLY):
        return text
    if path.endswith(CODE + (".def",)):
        pattern = r"/\*.*?\*/|//[^\n]*"
    else:
        pattern = r'"""(?:.*?)"""|(?m:^[ \t]*#[^\n]*)'
    out, end = [], 0  # what matches, with all line ends, so that lines keep their numbers
    for match in re.finditer(pattern, text, re.S):
        out += [re.sub(r"[^\n]", " ", text[end:match.start()]), match.group()]
        end = match.end()
    return "".join(out) + re.sub(r"[^\n]", " ", text[end:])


def exists(root, path, named):
    """From the root; source files also from src, include, tests, tools/csgmesh and the folders that the file is in."""
    places, folder = ["", "src", "include", "tests", "tools/csgmesh"], os.path.dirname(path)
    while folder:
        places.append(folder)
        folder = os.path.dirname(folder)
    return any(os.path.exists(os.path.join(root, place, named)) for place in places)


def check_paths(root, path):
    """Each path that is named and is not there, with its line."""
    with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
        text = file.read()
    for number, line in enumerate(remarks(path, text).split("\n"), 1):
        for match in PATH.finditer(line):
            named = match.group(1).rstrip(".")
            if not re.search(r"[*{}<]|NAME", named) and not exists(root, path, named):
                yield number, f"{named} is not there"


def pages(root):
    """What is read for paths: sources, tests, tools and documents, and the single files at the top."""
    yield from (path for path in files(root) if not path.startswith(os.path.join("tests", "data")) and
                not path.startswith(os.path.join("docs", "decisions")) and (path.endswith(PAGES) or is_script(os.path.join(root, path))))
    yield from (name for name in sorted(os.listdir(root)) if name.endswith(PAGES))
    scenes = os.path.join(root, "scenes")
    for place, _, names in os.walk(scenes):
        yield from (os.path.relpath(os.path.join(place, name), root) for name in sorted(names) if name.endswith(".md"))


def check_format(root):
    program = shutil.which("clang-format-14") or shutil.which("clang-format")
    version = subprocess.run([program, "--version"], capture_output=True, text=True,
                             check=True).stdout if program else ""
    if "version 14." not in version:
        print("clang-format 14 is not installed: skipped")
        return 77
    code = [path for path in files(root) if path.endswith(CODE)]
    return subprocess.run([program, "--dry-run", "-Werror"] + code, cwd=root,
                          check=False).returncode


def main():
    arguments = sys.argv[1:]
    wants_format = "--format" in arguments
    places = [a for a in arguments if a != "--format"]
    root = os.path.abspath(places[0] if places else os.path.join(os.path.dirname(__file__), ".."))
    if wants_format:
        return check_format(root)
    count = 0
    faults = [(path, fault) for path in files(root) for fault in check_file(root, path)]
    faults += [(path, fault) for path in pages(root) if path not in WITHOUT_PATHS for fault in check_paths(root, path)]
    faults += [(path, (line, fault)) for path, line, fault in check_types(root)]
    for path, (line, fault) in faults:
        print(f"{path}:{line}: {fault}")
        count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
