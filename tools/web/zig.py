#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""zig.py ZIG cc|c++ ARGUMENTS...: zig as a compiler for WebAssembly that Meson recognises.

Meson asks a linker for its version by an option that zig does not hand on, and knows lld by what it answers.
"""
import os
import sys

zig, tool, *arguments = sys.argv[1:]
if "-Wl,--version" in arguments:
    print("LLD 17 (compatible with GNU linkers)")
    sys.exit(0)
os.execv(zig, [zig, tool, "-target", "wasm32-wasi", *arguments])
