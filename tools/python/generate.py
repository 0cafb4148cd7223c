#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the Python names of the scene language of the tables that its evaluator and its manual are made of.

    generate.py _modules OUT     the modules: functions that make solids, and methods of solids (class Solid)
    generate.py functions OUT    the built-in functions: what they give is an expression

In: src/lang/modules/modules.def and src/lang/functions/functions.def, read by tools/manual/tables.py.
"""
import builtins
import keyword
import os
import sys
import textwrap

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "manual"))
from tables import calls  # noqa: E402 pylint: disable=wrong-import-position

WIDTH = 110
HEAD = '''# SPDX-License-Identifier: MIT
# Made by tools/python/generate.py of {source}.
"""{doc}"""
from __future__ import annotations
'''
# How functions.def calls what gives a blend.
BLENDS = ("blend", "profile", "rule", "arc")
# What a method of Solid may not be called, since Solid has another one of that name: render() of the language is group().
TAKEN = {"render": "csgmesh.render draws a picture"}
SPECIALS = "fn: Value = None, fa: Value = None, fs: Value = None"


def python_name(name):
    return name + "_" if keyword.iskeyword(name) else name


def sentence(text):
    return text[0].upper() + text[1:] + ("" if text.endswith(".") else ".")


def docstring(first, rest, indent):
    lines = textwrap.wrap(first, WIDTH - len(indent) - 3)
    if rest:
        lines += [""] + rest
    quoted = "\n".join((indent + line).rstrip() for line in lines).lstrip().replace("\\", "\\\\")
    return f'{indent}"""{quoted}\n{indent}"""' if len(lines) > 1 else f'{indent}"""{quoted}"""'


def modules():
    """(name, handler, children, doc, [(parameter, how, default, unit, range, doc)]) of each module."""
    parameters, found = {}, []
    for macro, fields in calls("src/lang/modules/modules.def"):
        if macro == "CSG_PARAMETER":
            parameters.setdefault(fields[0], []).append(fields[1:])
        if macro == "CSG_MODULE":
            found.append(fields)
    for name, handler, children, doc in found:
        yield name, handler, children, doc, parameters.get(name, [])


def functions():
    """(name, handler, fewest, most, parameters, doc) of each built-in function."""
    for macro, fields in calls("src/lang/functions/functions.def"):
        if macro == "CSG_FUNCTION":
            yield fields


def parameter_lines(parameters):
    lines = []
    for name, _, default, unit, allowed, doc in parameters:
        facts = ", ".join(part for part in (unit, allowed, f"default {default}" if default else "") if part)
        text = f"{python_name(name)}: {doc}" + (f" ({facts})" if facts else "")
        lines += textwrap.wrap(text, WIDTH - 8, subsequent_indent="    ")
    return lines


def module_source(module, is_method):
    name, _, children, doc, parameters = module
    positional = [p[0] for p in parameters if p[1] == "POSITIONAL"]
    named = [p[0] for p in parameters if p[1] != "POSITIONAL"]
    takes = children != "0"
    places = ["self"] if is_method else []
    places += [f"{python_name(p)}: Value = None" for p in positional]
    if takes:
        # positional arguments that are solids are children: translate([1, 0, 0], a, b)
        places = [place.replace(": Value", ": Union[Value, SolidBase]") if place != "self" else place for place in places]
        places.append("*solids: SolidBase")
    else:
        places.append("*")
    places += [f"{python_name(p)}: Value = None" for p in named] + [SPECIALS]
    pairs = "".join(f'("{p}", {python_name(p)}), ' for p in positional)
    solids = "solids" if takes else "()"
    first = ", (self,)" if is_method else ""
    keys = "".join(f'"{p}": {python_name(p)}, ' for p in named) + '"fn": fn, "fa": fa, "fs": fs'
    indent = "    " if is_method else ""
    title = python_name(name)
    signature = f"{indent}def {title}({', '.join(places)}) -> Solid:"
    if len(signature) > WIDTH:
        whole = ", ".join(place.replace(" ", "\0") for place in ", ".join(places).split(", "))
        lines = [line.replace("\0", " ") for line in textwrap.wrap(whole, WIDTH - len(indent) - 8, break_long_words=False)]
        signature = f"{indent}def {title}(\n" + "\n".join(f"{indent}        {line}" for line in lines) + f"\n{indent}) -> Solid:"
    return "\n".join([
        signature, docstring(sentence(doc), parameter_lines(parameters), indent + "    "),
        f'{indent}    return Solid._call("{name}", ({pairs}), {solids}, {{{keys}}}, {takes}{first})'])


def blend_method(function):
    name, _, fewest, most, parameters, doc = function
    what = doc.split(": ", 1)[-1]
    return "\n".join([
        f"    def {python_name(name)}(self, *arguments: Value, **named: Value) -> Solid:",
        docstring(f"The union, intersection or difference with this blend, {name}({parameters}): {what}.", [], "        "),
        f'        return self._blended(call_function("{name}", arguments, named, {fewest}, {most}, True), "{name}")'])


def blends():
    return [f for f in functions() if f[1] in BLENDS]


def make_modules():
    print(HEAD.format(source="src/lang/modules/modules.def and src/lang/functions/functions.def",
                      doc="The modules of the scene language: functions that make solids, and methods of solids."))
    print("from typing import TYPE_CHECKING, Union\n\nfrom ._solid import SolidBase, call_function\n\n"
          "if TYPE_CHECKING:\n    from ._types import Value\n")
    every = list(modules())
    methods = [m for m in every if m[2] != "0" and m[0] not in TAKEN]
    print('\nclass Solid(SolidBase):\n    __doc__ = SolidBase.__doc__\n    __slots__ = ()\n')
    taken = {m[0] for m in methods}
    print("\n\n".join([module_source(m, True) for m in methods] + [blend_method(f) for f in blends() if f[0] not in taken]))
    for module in every:
        print("\n\n" + module_source(module, False))
    print("\n\n__all__ = [\n" + "\n".join(f'    "{python_name(m[0])}",' for m in every if m[0] not in TAKEN) + "\n]")


def make_functions():
    print(HEAD.format(source="src/lang/functions/functions.def",
                      doc="The built-in functions of the scene language; what they give is an expression of the scene."))
    print("from typing import TYPE_CHECKING\n\nfrom ._solid import Expression, call_function\n\n"
          "if TYPE_CHECKING:\n    from ._types import Value\n")
    for name, handler, fewest, most, parameters, doc in functions():
        is_blend = handler in BLENDS or name == "round"
        what = docstring(f"{name}({parameters}): {doc}.", [], "    ")
        print("\n".join(["", f"def {python_name(name)}(*arguments: Value, **named: Value) -> Expression:", what,
                         f'    return call_function("{name}", arguments, named, {fewest}, {most}, {is_blend})', ""]))
    names = [f for f in functions() if f[1] in BLENDS or f[1] == "step"]
    print("\n#: Those that say how solids join: they are names of the package, too.\n__all__ = [\n"
          + "\n".join(f'    "{python_name(f[0])}",' for f in names if not hasattr(builtins, f[0])) + "\n]")


def main():
    what, path = sys.argv[1:3]
    with open(path, "w", encoding="utf-8") as file:
        sys.stdout = file
        make_modules() if what == "_modules" else make_functions()


if __name__ == "__main__":
    main()
