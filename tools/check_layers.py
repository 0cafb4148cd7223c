#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Folder order is data order: every #include in src/ and tools/ must name its own folder or one above, and modules
include each other in no circle but the few of CIRCLES.

Prints one line a fault and exits 1 when there is any. The order is that of src/README.md.
"""
import os
import re
import sys

ORDER = ["base", "text", "shape", "outline", "scene", "solid", "lang", "field", "grid", "mesh", "io", "render", "diff", "measure", "clearance", "walls", "slice", "api"]

# The folders of a layer in their order; files beside them may include any of them and be included by any.
PARTS = {
    "shape": ["plane", "polyhedra"],
    "outline": ["letters", "svg", "dxf", "heights"],
    "scene": ["formula", "primitives", "operators", "boxes", "tree", "lazy", "outlines"],
    "lang": ["parse", "evaluate", "functions", "modules", "parameters", "edit"],
    "field": ["kernels", "gradients", "prune", "compile", "cones", "taylor"],
    "grid": ["octree", "adaptive", "certify"],
    "mesh": ["marching", "features", "figures", "remesh", "adaptive", "distance", "reshape", "own", "foreign", "pipeline"],
    "io": ["text", "formats", "gltf", "threemf", "drawings", "layers"],
}

# What customers include.
PUBLIC = {"csgmesh/clearance.h", "csgmesh/csgmesh.h", "csgmesh/editing.h", "csgmesh/fabrication.h", "csgmesh/figures.h", "csgmesh/ranks.h", "csgmesh/reshaping.h", "csgmesh/slicing.h"}

# Made by the build.
GENERATED = {"report_page.inc"}

# Circles of modules that may be, and why. A module is NAME.c with NAME.h. In the last two the second is a helper of the first,
# in a file of its own for its length: it takes the types that the first one's header declares.
CIRCLES = {
    frozenset({"field/compile/compile_curve", "field/compile/compile_leaf"}):
        "a curve is a leaf that makes leaves: it is packed by the rules of all others",
    frozenset({"lang/evaluate/rule_value", "lang/evaluate/value"}): "a rule is a value and holds values",
    frozenset({"scene/operators/blend_kinds", "scene/operators/rule"}): "a rule is a kind of blend and asks the table of kinds",
    frozenset({"field/cones/cone", "field/cones/cone_along"}): "cone_along takes the cones that cone.h declares",
    frozenset({"scene/tree/build", "scene/tree/check"}): "check.h takes the builder that build.h declares",
}

# The scene layer knows nothing of text: spans are plain numbers there.
FORBIDDEN = {("scene", "text"): "scenes know nothing of text"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]')


def includes(path):
    """Yields (line number, quote, name) of each include of a file."""
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            found = INCLUDE.match(line)
            if found:
                yield number, found.group(1), found.group(2)


def sources(folder):
    for root, _, names in sorted(os.walk(folder)):
        for name in sorted(names):
            if name.endswith((".c", ".h", ".cc", ".def", ".inc")):
                yield os.path.join(root, name)


def fault_in_layer(layer, quote, name):
    """Why a file of `layer` may not include `name`, or None."""
    if quote == "<":
        return "the public header is included with quotes" if name.startswith("csgmesh/") else None
    if name in PUBLIC:
        return None
    folder = name.split("/")[0]
    if "/" not in name or folder not in ORDER:
        return f"write the path from src/, as \"{layer}/{name}\""
    if ORDER.index(folder) > ORDER.index(layer):
        return f"{layer}/ stands above {folder}/ and must not know it"
    return FORBIDDEN.get((layer, folder))


def fault_in_part(path, name):
    """Why a file of a layer's folder may not include `name` of a later one, or None."""
    own, other = path.split("/"), name.split("/")
    if len(own) < 3 or len(other) < 3 or own[0] != other[0]:
        return None
    parts = PARTS.get(own[0])
    if not parts:
        return None
    for part in (own[1], other[1]):
        if part not in parts:
            return f"no folder '{part}' of {own[0]}/ in tools/check_layers.py"
    if parts.index(other[1]) > parts.index(own[1]):
        return f"{own[0]}/{own[1]}/ stands above {own[0]}/{other[1]}/ and must not know it"
    return None


def check_source(root):
    for path in sources(os.path.join(root, "src")):
        layer = os.path.relpath(path, os.path.join(root, "src")).split(os.sep)[0]
        if layer not in ORDER:
            yield path, 1, f"no layer '{layer}' in the order of tools/check_layers.py"
            continue
        for number, quote, name in includes(path):
            fault = fault_in_layer(layer, quote, name) or fault_in_part(
                os.path.relpath(path, os.path.join(root, "src")).replace(os.sep, "/"), name)
            if fault:
                yield path, number, fault


def module_graph(root):
    """module -> the modules that its .c, .cc and .h include. .def files are data; what NAME_private.h takes from
    NAME.h, to hand both to the files of a module that is in several, is no circle."""
    graph = {}
    for path in sources(os.path.join(root, "src")):
        name, ending = os.path.splitext(os.path.relpath(path, os.path.join(root, "src")).replace(os.sep, "/"))
        if ending in (".c", ".cc", ".h"):
            graph.setdefault(name, set()).update(
                os.path.splitext(other)[0] for _, quote, other in includes(path)
                if quote == '"' and other.endswith(".h"))
    return {name: {other for other in others if other in graph and name not in (other, other + "_private")}
            for name, others in graph.items()}


def circles(graph):
    """The sets of modules that reach each other: strongly connected components of more than one (Tarjan 1972)."""
    index, low, waiting, found = {}, {}, [], []

    def visit(name):
        index[name] = low[name] = len(index)
        waiting.append(name)
        for other in sorted(graph[name]):
            if other not in index:
                visit(other)
            if other in waiting:
                low[name] = min(low[name], low[other])
        if low[name] == index[name]:
            at = waiting.index(name)
            if len(waiting) - at > 1:
                found.append(sorted(waiting[at:]))
            del waiting[at:]

    for name in sorted(graph):
        if name not in index:
            visit(name)
    return sorted(found)


def check_circles(root):
    found = circles(module_graph(root))
    for circle in found:
        if frozenset(circle) not in CIRCLES:
            first = next(os.path.join(root, "src", circle[0] + ending) for ending in (".c", ".cc", ".h")
                         if os.path.exists(os.path.join(root, "src", circle[0] + ending)))
            yield first, 1, "modules include each other in a circle: " + ", ".join(circle)
    here = os.path.abspath(os.path.join(os.path.dirname(__file__), ".."))
    for circle in CIRCLES if root == here else ():
        if sorted(circle) not in found:
            yield __file__, 1, "no circle any more, but still allowed: " + ", ".join(sorted(circle))


def check_tools(root):
    """Programs use the public header and files of their own folder, named from there; nothing of src/."""
    tools = os.path.join(root, "tools")
    for path in sources(tools):
        program = os.path.join(tools, os.path.relpath(path, tools).split(os.sep)[0])
        for number, quote, name in includes(path):
            if quote != '"' or name in PUBLIC:
                continue
            if name in GENERATED or os.path.exists(os.path.join(program, name)):
                continue
            if name.split("/")[0] in ORDER:
                yield path, number, "tools/ includes csgmesh/csgmesh.h, clearance.h, editing.h, fabrication.h, figures.h, reshaping.h and slicing.h only"
            else:
                yield path, number, f"no file '{name}' in the program's folder"


def main():
    root = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else
                           os.path.join(os.path.dirname(__file__), ".."))
    faults = list(check_source(root)) + list(check_circles(root)) + list(check_tools(root))
    for path, number, fault in faults:
        print(f"{os.path.relpath(path, root)}:{number}: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
