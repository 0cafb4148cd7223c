#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Keeps the tables of the manuals, and the lists of formats in other files, as the program's own lists say.

    python3 tools/manual/tables.py            rewrites the files
    python3 tools/manual/tables.py --check    exit status 1 when that would change something

In: the .def files of src/lang, src/scene, src/base and src/io. A marker pair <!-- begin NAME --> and
<!-- end NAME --> in a page of PAGES holds the table that its function makes; LISTS says where formats are
listed in one line.
"""
import os
import re
import sys

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))


def calls(path):
    """(macro, [arguments]) of every macro call in a .def file; strings without their quotes."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
    for call in re.finditer(r'(CSG_\w+)\(((?:"(?:\\.|[^"\\])*"|[^()"])*)\)', text):
        arguments = [""]
        for string, comma, other in re.findall(r'"((?:\\.|[^"\\])*)"|(,)|([^,"]+)', call.group(2)):
            if comma:
                arguments.append("")
            else:
                arguments[-1] += re.sub(r"\\(.)", r"\1", string) if string else other.strip()
        yield call.group(1), arguments


def cell(text):
    return text.replace("|", "\\|")


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return lines + ["| " + " | ".join(cell(c) for c in row) + " |" for row in rows]


def code(text):
    return f"`{text}`" if text else ""


# What makes a figure of the plane; what makes one solid or figure of others.
FIGURES = {"circle", "square", "polygon", "text"}
SHAPING = {"linear_extrude", "rotate_extrude", "offset", "projection", "hull", "minkowski", "resize",
           "offset3d", "shell", "repeat", "twist", "bend", "extrude", "warp"}


def module_group(macro, name, handler, children):
    if macro == "CSG_CONTROL":
        return "control"
    if handler in ("union", "intersection", "difference", "blend", "group", "combine", "soft"):
        return "operators"
    if children != "0":
        return "shaping" if name in SHAPING else "transforms"
    return "figures" if name in FIGURES else "solids"


def modules(group):
    parameters, found = {}, []
    for macro, fields in calls("src/lang/modules/modules.def"):
        if macro in ("CSG_MODULE", "CSG_CONTROL") and module_group(macro, *fields[:3]) == group:
            found.append(fields)
        if macro == "CSG_PARAMETER":
            parameters.setdefault(fields[0], []).append(fields[1:])
    rows = []
    for name, _, _, doc in found:
        rows.append([f"**{code(name)}**", "", "", "", doc])
        for parameter, how, default, unit, allowed, meaning in parameters.get(name, []):
            shown = parameter if how == "POSITIONAL" else parameter + " ="
            limits = ", ".join(part for part in (unit, allowed) if part)
            rows.append(["", code(shown), default, limits, meaning])
    if group == "control":
        return table(["module", "what it does"], [[row[0], row[4]] for row in rows])
    return table(["module", "parameter", "default", "kind and range", "meaning"], rows)


def functions():
    rows = []
    for _, (name, _, _, _, parameters, doc) in calls("src/lang/functions/functions.def"):
        rows.append([code(f"{name}({parameters})"), doc])
    return table(["function", "gives"], rows)


def number_range(least, is_open, most):
    if float(most) >= 1e15:
        return f"> {least}" if is_open == "1" else f">= {least}"
    return f"> {least}, <= {most}" if is_open == "1" else f"{least} .. {most}"


# What an interval rule means, by its name in operators.def.
INTERVALS = {"CORNERS": "yes", "ANGLES": "without a profile", "TURNS": "without debulge",
             "EXTERIOR": "no", "INTERIOR": "no"}


def rules(space):
    parameters, rows = {}, []
    for macro, fields in calls("src/scene/operators/operators.def"):
        if macro == "CSG_RULE_PARAMETER":
            parameters.setdefault(fields[0], []).append(fields[1:])
    for macro, fields in calls("src/scene/operators/operators.def"):
        if macro != "CSG_RULE" or fields[2] != space:
            continue
        constant, name, _, fold, interval, _, slope, equal, doc = fields
        joins = "from the left" if fold == "1" else "all at once"
        rows.append([f"**{code(name)}**", doc, f"joins {joins}; monotone: {INTERVALS[interval]}; K: {slope}",
                     equal])
        for parameter, default, least, is_open, most, unit, meaning in parameters.get(constant, []):
            rows.append([code(parameter), f"{meaning} (default {default})",
                         f"{unit}, {number_range(least, is_open, most)}", ""])
    return table(["blend, parameters", "what it is", "facts and ranges", "is an operand itself where"], rows)


def distances():
    """Primitives by what their fields are, as their traits promise."""
    groups = {}
    for macro, fields in calls("src/scene/primitives/primitives.def"):
        if macro in ("CSG_PRIMITIVE", "CSG_CURVE_PRIMITIVE"):
            exact = "CSG_TRAIT_EXACT" in fields[3]
            kind = (exact or "CSG_TRAIT_OUTSIDE" in fields[3], exact or "CSG_TRAIT_INSIDE" in fields[3])
            name = code(fields[4].split("(")[0])
            if name not in groups.setdefault(kind, []):
                groups[kind].append(name)
    words = {True: "exact", False: "a bound"}
    return table(["solid", "field outside", "field inside"],
                 [[", ".join(names), words[outside], words[inside]]
                  for (outside, inside), names in sorted(groups.items(), reverse=True)])


def steps():
    rows = [[code(f"{name}({least} .. {most})"), standard, "yes" if even == "1" else "no", doc]
            for _, (_, name, standard, least, most, _, even, doc) in calls("src/scene/operators/steps.def")]
    return table(["step", "default", "order of the operands does not matter", "what it is"], rows)


def falloffs():
    rows = [[code(f'"{name}"'), doc.replace("^2", "²").replace("^4", "⁴").replace("^6", "⁶").replace("^3", "³"),
             f"{float(iso):.6f}", f"{float(steepest):.6f}"]
            for _, (_, name, iso, steepest, _, doc) in calls("src/scene/operators/falloffs.def")]
    return table(["falloff", "P(d)", "1/2 at d =", "steepest"], rows)


def unsupported():
    rows = []
    for _, (name, instead) in calls("src/lang/evaluate/unsupported_modules.def"):
        rows.append([code(name), "" if instead == "NULL" else instead])
    return table(["not there yet", "until then"], rows)


def diagnostics():
    rows = []
    tables = [*calls("src/base/scene_codes.def"), *calls("src/base/mesh_codes.def")]
    for _, (_, number, severity, summary) in tables:
        lenient = severity == "CSG_STRICT_ERROR"
        word = "error" if lenient else severity.removeprefix("CSGM_").lower()
        rows.append([f"{word[0].upper()}{int(number):04d}", word + (", lenient: warning" if lenient else ""), summary])
    return table(["code", "severity", "what was found"], rows)


def format_rows():
    """(name, title, way, traits, remarks) of each mesh format."""
    for macro, fields in calls("src/io/formats.def"):
        if macro == "CSG_FORMAT":
            _, name, title, way, _, _, _, _, traits, _, remarks = fields
            yield name, title, way, set(re.findall(r"\w+", traits)), remarks


def formats():
    rows = []
    for name, title, way, traits, remarks in format_rows():
        kept = ["yes" if f"CSGM_KEEPS_{what}" in traits else "no" for what in ("NORMALS", "COLORS", "NAMES", "MATERIALS", "DOUBLES")]
        rows.append([code("." + name), title, {"READ_WRITE": "both", "WRITE_ONLY": "written", "READ_ONLY": "read"}[way],
                     *kept, remarks])
    return table(["extension", "", "written, read", "normals", "colours", "parts, names", "materials", "doubles", "remarks"],
                 rows)


def command_options(command):
    """The options that a command takes, from the table that its help is made of; its own words for them win."""
    with open(os.path.join(ROOT, "tools/csgmesh/core/options.def"), encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", " ", file.read(), flags=re.S)
    with open(os.path.join(ROOT, "tools/csgmesh/core/command_bits.h"), encoding="utf-8") as file:
        sets = dict(re.findall(r"^ *(ANY\w*) = (.*?),?(?: */\*.*)?$", file.read(), flags=re.M))

    def takes(names):
        if "& ~" in names:
            taken, _, without = names.partition("& ~")
            return takes(taken) and not takes(without.strip("() "))
        found = [name.strip("() ") for name in names.split("|")]
        return any(name == command or "CLI_COMMAND_COUNT" in name or (name in sets and takes(sets[name])) for name in found)

    string = r'"((?:[^"\\]|\\.|"\s*")*)"'
    own = {field: words for field, commands, words in
           re.findall(r"HELP_FOR\((\w+), ([^,]*),\s*" + string + r"\)", text) if takes(commands)}
    rows = []
    for field, letter, name, _, argument, commands, words in re.findall(
            r"OPTION\((\w+), ('.'|0), (\"[\w-]+\"|NULL), (\w+),\s*(\"[^\"]*\"|NULL),\s*([^,]*),\s*" + string + r"\)", text):
        if not takes(commands):
            continue
        forms = ([f"-{letter[1]}"] if letter != "0" else []) + ([f"--{name.strip(chr(34))}"] if name != "NULL" else [])
        value = "" if argument == "NULL" else " " + argument.strip('"')
        words = re.sub(r'"\s*"', "", own.get(field, words))
        rows.append([code(", ".join(forms) + value), words])
    return table(["option", "what it does"], rows)


def format_names(way="READ_ONLY", between=", "):
    """The names of the formats, without those of one way."""
    return between.join(name for name, _, row_way, _, _ in format_rows() if row_way != way)


PAGES = {
    "README.md": {"formats": formats},
    "docs/convert.md": {"convert options": lambda: command_options("CONVERT")},
    "scenes/README.md": {
        "figures": lambda: modules("figures"),
        "solids": lambda: modules("solids"),
        "distances": distances,
        "shaping": lambda: modules("shaping"),
        "transforms": lambda: modules("transforms"),
        "rules of lengths": lambda: rules("LENGTHS"),
        "rules of fields": lambda: rules("FIELDS"),
        "steps": steps,
        "falloffs": falloffs,
        "operators": lambda: modules("operators"),
        "control": lambda: modules("control"),
        "functions": functions,
        "unsupported": unsupported,
        "diagnostics": diagnostics,
    },
}

# Files that list the formats in one line: what stands before, between and behind the list.
LISTS = {
    "tools/integrations/batch.schema.json": (r'"description": "', ", ", r'; default glb"'),
    "tools/integrations/make/csgmesh.mk": (r"CSGMESH_FORMATS \?= ", " ", r"$"),
}


def renew_page(path, text):
    for name, make in PAGES[path].items():
        begin, end = f"<!-- begin {name} -->", f"<!-- end {name} -->"
        before, _, rest = text.partition(begin)
        _, found, after = rest.partition(end)
        if not found:
            sys.exit(f"{path}: no markers for the table '{name}'")
        text = before + "\n".join([begin] + make() + [end]) + after
    return text


def renew_list(path, text):
    before, between, behind = LISTS[path]
    pattern = re.compile(f"({before})[a-z0-9, ]+({behind})", re.M)
    if len(pattern.findall(text)) != 1:
        sys.exit(f"{path}: not one list of formats")
    return pattern.sub(lambda found: found.group(1) + format_names(between=between) + found.group(2), text)


def main():
    stale = []
    for paths, renew in ((PAGES, renew_page), (LISTS, renew_list)):
        for path in paths:
            full = os.path.join(ROOT, path)
            with open(full, encoding="utf-8") as file:
                old = file.read()
            new = renew(path, old)
            if new == old:
                continue
            stale.append(path)
            if "--check" not in sys.argv[1:]:
                with open(full, "w", encoding="utf-8") as file:
                    file.write(new)
    if stale and "--check" in sys.argv[1:]:
        print(", ".join(stale), "not up to date: run python3 tools/manual/tables.py")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
