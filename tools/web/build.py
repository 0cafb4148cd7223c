#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""build.py [FOLDER] [--bare]: the compiler as WebAssembly with SIMD128, FOLDER/csgmesh.wasm; without FOLDER in build-web.

zig is the compiler: $ZIG, or PyPI's ziglang, which is installed into FOLDER/python once. The optional libraries are
those of libraries.py; --bare has none of them, and needs no Debian. Exit status: 0; 1 where the build fails; 77 where a
tool is missing, which is named.
"""
import argparse
import os
import shutil
import subprocess
import sys

import libraries

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PLACE = os.path.join(ROOT, "build-web")
ZIGLANG = "ziglang==0.17.1"
LACKING = 77

# What wasi-libc does as well as it can.
EMULATED = {"PROCESS_CLOCKS": "process-clocks", "SIGNAL": "signal", "GETPID": "getpid", "MMAN": "mman"}

# Warnings are the native build's task. Paths in the module do not tell where it was built.
ARGUMENTS = (["-msimd128", "-w", "-include", os.path.join(HERE, "wasm", "missing.h"), "-ffunction-sections", "-fdata-sections",
              f"-ffile-prefix-map={ROOT}=."] + [f"-D_WASI_EMULATED_{name}" for name in EMULATED])

CROSS = """[binaries]
c = [{python}, {wrapper}, {zig}, 'cc']
cpp = [{python}, {wrapper}, {zig}, 'c++']
ar = [{zig}, 'ar']
pkg-config = 'pkg-config'
pkgconfig = 'pkg-config'
[host_machine]
system = 'wasi'
cpu_family = 'wasm32'
cpu = 'wasm32'
endian = 'little'
[properties]
needs_exe_wrapper = true
pkg_config_libdir = {pkgconfig}
[built-in options]
c_args = {c}
cpp_args = {cpp}
c_link_args = {link}
cpp_link_args = {link}
"""


def give_up(reason):
    print(f"tools/web/{os.path.basename(sys.argv[0])}: {reason}", file=sys.stderr)
    sys.exit(LACKING)


def find_zig(place):
    """zig's path."""
    zig = os.environ.get("ZIG")
    if zig:
        return os.path.abspath(zig)
    packages = os.path.join(place, "python")
    zig = os.path.join(packages, "ziglang", "zig")
    if not os.path.exists(zig):
        done = subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", packages, ZIGLANG],
                              capture_output=True, text=True, check=False)
        if done.returncode or not os.path.exists(zig):
            give_up(f"no $ZIG, and pip cannot install {ZIGLANG}: {(done.stderr.strip().splitlines() or ['no reason given'])[-1]}")
    return zig


def write_cross_file(place, zig, pkgconfig, objects, options):
    """Its path; what was configured by another one, or with other options, is removed."""
    link = [f"-lwasi-emulated-{library}" for library in EMULATED.values()] + objects
    arguments = ARGUMENTS + (libraries.EXCEPTIONS if objects else [])
    path = os.path.join(place, "cross.ini")
    text = CROSS.format(python=repr(sys.executable), wrapper=repr(os.path.join(HERE, "zig.py")), zig=repr(zig),
                        pkgconfig=repr(pkgconfig), c=arguments, cpp=arguments, link=link) + f"# {' '.join(options)}\n"
    before = ""
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            before = file.read()
    if before != text:
        shutil.rmtree(os.path.join(place, "module"), ignore_errors=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def configure(place, zig, bare):
    """The folder that Meson has prepared."""
    folder, options = os.path.join(place, "module"), []
    try:
        made = ("", []) if bare else libraries.build_all(zig, place)
    except libraries.Lacking as lacking:
        give_up(f"{lacking}; --bare builds without libraries")
    if not bare:
        options = [f"-D{feature}=enabled" for feature in libraries.FEATURES] + [f"-Done_font={libraries.FONT}={libraries.FONT_PATH}"]
    cross = write_cross_file(place, zig, *made, options)
    if not os.path.exists(os.path.join(folder, "build.ninja")):
        libraries.run(["meson", "setup", folder, ROOT, "--cross-file", cross, "--buildtype=release", "-Doptimization=2",
                       "-Dwerror=false", "-Dauto_features=disabled", *options])
    return folder


def main(place, bare):
    """The module's path."""
    for tool in ("meson", "ninja", "pkg-config"):
        if not shutil.which(tool):
            give_up(f"{tool} is not there")
    place = os.path.abspath(place)
    os.makedirs(place, exist_ok=True)
    folder = configure(place, find_zig(place), bare)
    libraries.run(["ninja", "-C", folder, "tools/csgmesh/csgmesh-web.wasm"])
    target = os.path.join(place, "csgmesh.wasm")
    shutil.copyfile(os.path.join(folder, "tools", "csgmesh", "csgmesh-web.wasm"), target)
    return target


def read_arguments(description):
    """(place, bare) of the command line."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", default=PLACE)
    parser.add_argument("--bare", action="store_true", help="without the optional libraries")
    given = parser.parse_args()
    return given.folder, given.bare


if __name__ == "__main__":
    print(main(*read_arguments(__doc__)))
