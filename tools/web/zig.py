#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""zig.py ZIG cc|c++ ARGUMENTS...: zig as a compiler for WebAssembly that Meson recognises.

Meson asks a linker for its version by an option that zig does not hand on, and knows lld by what it answers. Code is
made for its place, since a module is linked once: -fPIC, which the build asks for, would have it look up every address.
"""
import os
import sys

# Where little of a mesh's time is spent, code is made small: what a page must load counts there.
SMALL = ("src/api/", "src/diff/", "src/io/", "src/lang/", "src/outline/", "src/render/", "src/solid/", "src/text/", "tools/csgmesh/")

zig, tool, *arguments = sys.argv[1:]
if "-Wl,--version" in arguments:
    print("LLD 17 (compatible with GNU linkers)")
    sys.exit(0)
sources = [argument for argument in arguments if argument.endswith((".c", ".cc"))]
small = ["-Os"] if any(folder in source for folder in SMALL for source in sources) else []
arguments = [argument for argument in arguments if argument != "-fPIC"]
os.execv(zig, [zig, tool, "-target", "wasm32-wasi", *arguments, *small])
