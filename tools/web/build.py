#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""build.py [FOLDER]: the compiler as WebAssembly with SIMD128, FOLDER/csgmesh.wasm; without FOLDER in build-web.

zig is the compiler: $ZIG, or PyPI's ziglang, which is installed into FOLDER/python once. None of the optional
libraries are in the module. Exit status: 0; 1 where the build fails; 77 where a tool is missing, which is named.
"""
import os
import shutil
import subprocess
import sys

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
[host_machine]
system = 'wasi'
cpu_family = 'wasm32'
cpu = 'wasm32'
endian = 'little'
[properties]
needs_exe_wrapper = true
[built-in options]
c_args = {c}
cpp_args = {cpp}
c_link_args = {link}
cpp_link_args = {link}
"""


def run(command):
    """Silently; what it says is shown when it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}\n{done.stdout}")


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


def write_cross_file(place, zig):
    link = [f"-lwasi-emulated-{library}" for library in EMULATED.values()]
    path = os.path.join(place, "cross.ini")
    text = CROSS.format(python=repr(sys.executable), wrapper=repr(os.path.join(HERE, "zig.py")), zig=repr(zig),
                        c=ARGUMENTS, cpp=ARGUMENTS, link=link)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def main(place):
    """The module's path."""
    for tool in ("meson", "ninja"):
        if not shutil.which(tool):
            give_up(f"{tool} is not there")
    place = os.path.abspath(place)
    os.makedirs(place, exist_ok=True)
    zig = find_zig(place)
    folder = os.path.join(place, "module")
    if not os.path.exists(os.path.join(folder, "build.ninja")):
        run(["meson", "setup", folder, ROOT, "--cross-file", write_cross_file(place, zig),
             "--buildtype=release", "-Doptimization=2", "-Dwerror=false", "-Dauto_features=disabled"])
    run(["ninja", "-C", folder, "tools/csgmesh/csgmesh-web.wasm"])
    target = os.path.join(place, "csgmesh.wasm")
    shutil.copyfile(os.path.join(folder, "tools", "csgmesh", "csgmesh-web.wasm"), target)
    return target


if __name__ == "__main__":
    print(main(sys.argv[1] if len(sys.argv) > 1 else PLACE))
