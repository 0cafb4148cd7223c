#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The outside libraries of the build for WebAssembly: Debian's sources, compiled by zig, with files for pkg-config that
csgmesh's own build finds them by.

The sources are those of the Debian release that this machine has, fetched by apt-get with lists of its own: what the
command line is linked with is what the page has, so what they make has the same bytes.
"""
import concurrent.futures
import glob
import hashlib
import os
import re
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))

# What C++ throws and what C jumps over, in the exceptions of WebAssembly that all browsers know since 2022.
EXCEPTIONS = ["-fwasm-exceptions", "-mexception-handling", "-mllvm", "-wasm-enable-eh", "-mllvm", "-wasm-enable-sjlj"]

# No library is debugged here: small code, vectors, sections that the linker may leave out, no warnings.
COMMON = ["-Os", "-msimd128", "-DNDEBUG", "-ffunction-sections", "-fdata-sections", "-ffp-contract=off", "-w"] + EXCEPTIONS

# Text is laid out by OpenType's own tables alone; nothing is drawn, serialised or read from files.
HARFBUZZ = ["-DHB_NO_" + what for what in (
    "MT", "AAT", "BITMAP", "BUFFER_MESSAGE", "BUFFER_SERIALIZE", "BUFFER_VERIFY", "CFF", "COLOR", "DRAW", "FACE_COLLECT_UNICODES",
    "GETENV", "HINTING", "LANGUAGE_LONG", "LAYOUT_COLLECT_GLYPHS", "MATH", "META", "MMAP", "NAME", "OPEN", "OT_FONT_GLYPH_NAMES",
    "EMOJI_SEQUENCES", "SETLOCALE", "STYLE", "SUBSET_LAYOUT")] + ["-DHB_DISABLE_DEPRECATED", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics"]

# name for pkg-config: Debian's source package, sources and folders of headers in it, flags, what it needs. What a
# library's own build would write into headers stands in config/NAME.
LIBRARIES = {
    "zlib": {"package": "zlib", "sources": ["*.c"], "include": ["."], "without": ["gz"], "library": "z"},
    "polyclipping": {"package": "libpolyclipping", "sources": ["cpp/clipper.cpp"], "include": ["cpp"],
                     "flags": ["-std=c++20", "-include", os.path.join(HERE, "config", "polyclipping", "sort.h")]},
    "qhull_r": {"package": "qhull", "sources": ["src/libqhull_r/*.c"], "include": ["src"], "without": ["rbox", "userprintf"],
                "flags": ["-Dqh_NOtrace", "-include", os.path.join(HERE, "config", "qhull_r", "silent.h")]},
    "expat": {"package": "expat", "sources": ["expat/lib/xml*.c"], "include": ["expat/lib"], "flags": ["-DXML_STATIC"]},
    "freetype2": {"package": "freetype", "include": ["include"], "needs": ["zlib"], "library": "freetype",
                  "sources": ["src/base/ftinit.c", "src/base/ftbase.c", "src/base/ftsystem.c", "src/base/ftdebug.c",
                              "src/base/ftmm.c", "src/base/ftbitmap.c", "src/gzip/ftgzip.c", "src/truetype/truetype.c",
                              "src/sfnt/sfnt.c"],
                  "flags": ["-DFT2_BUILD_LIBRARY", "-DFT_CONFIG_OPTION_SYSTEM_ZLIB", "-DFT_CONFIG_MODULES_H=<freetype_modules.h>",
                            "-DFT_CONFIG_OPTIONS_H=<freetype_options.h>"]},
    "harfbuzz": {"package": "harfbuzz", "sources": ["src/harfbuzz.cc"], "include": ["src"], "flags": HARFBUZZ},
    "fribidi": {"package": "fribidi", "sources": ["lib/*.c"], "include": ["lib"], "flags": ["-DHAVE_CONFIG_H", "-DFRIBIDI_BUILD"]},
    # Archives in memory are read, by one thread; there are no ciphers and no temporary files.
    "libzip": {"package": "libzip", "sources": ["lib/zip_*.c"], "include": ["lib"], "needs": ["zlib"], "library": "zip",
               "without": ["win32", "uwp", "crypto", "aes", "bzip2", "xz", "fdopen", "mkstempm", "stdio_named"],
               "flags": ["-DHAVE_CONFIG_H", "-Wno-error=implicit-function-declaration"]},
}

# Options of Meson that these are for.
FEATURES = ("clipper", "qhull", "expat", "freetype", "fribidi", "threemf")


# The font of a page, of Debian's package, and where scenes see it.
FONT, FONT_PACKAGE, FONT_PATH = "Liberation Sans", "fonts-liberation", "/fonts/LiberationSans-Regular.ttf"


class Lacking(Exception):
    """What the build needs is not there; the reason."""


def run(command, **more):
    """Silently; what it says is shown when it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, **more)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


class Debian:
    """apt-get with lists and caches of its own below `place`, whatever the machine's know."""

    def __init__(self, place):
        self.place = place
        self.options = ["-o", "Dir::Etc::SourceList=/dev/null", "-o", f"Dir::Etc::SourceParts={place}/sources.d",
                        "-o", f"Dir::State::Lists={place}/lists", "-o", f"Dir::Cache={place}/cache", "-o", "APT::Get::List-Cleanup=0",
                        "-o", "APT::Sandbox::User=root"]
        self.is_ready = False

    def get(self, *words):
        done = subprocess.run(["apt-get", *self.options, *words], cwd=self.place, capture_output=True, text=True, check=False)
        if done.returncode:
            raise Lacking(f"apt-get {words[0]}: {(done.stderr.strip().splitlines() or ['no reason given'])[-1]}")

    def prepare(self):
        if self.is_ready:
            return
        for folder in ("sources.d", "lists/partial", "cache/archives/partial"):
            os.makedirs(os.path.join(self.place, folder), exist_ok=True)
        with open("/etc/os-release", encoding="utf-8") as file:
            release = dict(line.rstrip("\n").split("=", 1) for line in file if "=" in line)
        if release.get("ID") != "debian":
            raise Lacking("the libraries are those of Debian, and this is another system")
        with open(os.path.join(self.place, "sources.d", "sources.sources"), "w", encoding="utf-8") as file:
            file.write("Types: deb deb-src\nURIs: http://deb.debian.org/debian\n"
                       f"Suites: {release['VERSION_CODENAME']}\nComponents: main\n"
                       "Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg\n")
        self.get("update")
        self.is_ready = True

    def source(self, package):
        """(folder, version of the authors); it is fetched once."""
        found = self.find(package)
        if not found:
            self.prepare()
            self.get("source", "--only-source", package)
            found = self.find(package)
        return found

    def font(self):
        """The font's file, and the text of its licence."""
        folder = os.path.join(self.place, FONT_PACKAGE)
        found = os.path.join(folder, "usr/share/fonts/truetype/liberation", os.path.basename(FONT_PATH))
        if not os.path.exists(found):
            self.prepare()
            self.get("download", FONT_PACKAGE)
            run(["dpkg-deb", "-x", *glob.glob(os.path.join(self.place, FONT_PACKAGE + "_*.deb"))[:1], folder])
        return found, os.path.join(folder, "usr/share/doc", FONT_PACKAGE, "copyright")

    def find(self, package):
        for path in sorted(glob.glob(os.path.join(self.place, f"{package}-[0-9]*"))):
            if os.path.isdir(path):
                return path, path.rsplit("-", 1)[1].split("+")[0].removesuffix(".dfsg")
        return None


class Compiler:
    """Compiles for WebAssembly, each file once: an object's name tells what it was made of."""

    def __init__(self, zig, place):
        self.zig, self.place = zig, place
        os.makedirs(place, exist_ok=True)

    def object(self, source, flags):
        tool = "c++" if source.endswith((".cc", ".cpp")) else "cc"
        command = [self.zig, tool, "-target", "wasm32-wasi", "-c", source, *flags]
        with open(source, "rb") as file:
            name = hashlib.sha256(repr(command).encode() + file.read()).hexdigest()[:24] + ".o"
        path = os.path.join(self.place, name)
        if not os.path.exists(path):
            run(command + ["-o", path + ".part"])
            os.replace(path + ".part", path)
        return path

    def archive(self, path, sources, flags):
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            objects = list(pool.map(lambda source: self.object(source, flags), sources))
        if os.path.exists(path):
            os.remove(path)
        run([self.zig, "ar", "rcs", path, *objects])


def write_zip_errors(folder, target):
    """libzip's messages: its own build takes them from the comments of zip.h, and so does this."""
    with open(os.path.join(folder, "lib", "zip.h"), encoding="utf-8") as file:
        rows = re.findall(r"#define ZIP_ER_[A-Z_]+ [0-9]+\s+/\* ([NSZ]) ([^*]*?) \*/", file.read())
    kinds = {"N": "ZIP_ET_NONE", "S": "ZIP_ET_SYS", "Z": "ZIP_ET_ZLIB"}
    with open(target, "w", encoding="utf-8") as file:
        file.write('#include "zipint.h"\nconst char * const _zip_err_str[] = {\n' + "".join(f'    "{text}",\n' for _, text in rows) + "};\n"
                   "const int _zip_nerr_str = sizeof(_zip_err_str) / sizeof(_zip_err_str[0]);\n"
                   "const int _zip_err_type[] = {\n" + "".join(f"    {kinds[kind]},\n" for kind, _ in rows) + "};\n")
    return target


def headers_of(name, folders):
    """Folders of a library's headers."""
    row = LIBRARIES[name]
    return [os.path.join(HERE, "config", name)] + [os.path.normpath(os.path.join(folders[name][0], path)) for path in row["include"]]


def digest(folder):
    """Of the files in it."""
    texts = []
    for path in sorted(glob.glob(os.path.join(folder, "*"))):
        with open(path, "rb") as file:
            texts.append(file.read())
    return hashlib.sha256(b"".join(texts)).hexdigest()[:8]


def write_pkgconfig(prefix, name, version, include, archives):
    with open(os.path.join(prefix, "pkgconfig", name + ".pc"), "w", encoding="utf-8") as file:
        file.write(f"Name: {name}\nDescription: {name}\nVersion: {version}\nCflags: {' '.join('-I' + path for path in include)}\n"
                   f"Libs: {' '.join(os.path.join(prefix, f'lib{archive}.a') for archive in archives)}\n")


def build_library(compiler, name, folders, prefix):
    row = LIBRARIES[name]
    folder, version = folders[name]
    needs = row.get("needs", [])
    include = [path for one in (name, *needs) for path in headers_of(one, folders)]
    sources = sorted(path for pattern in row["sources"] for path in glob.glob(os.path.join(folder, pattern))
                     if not any(word in os.path.basename(path) for word in row.get("without", [])))
    if name == "libzip":
        sources.append(write_zip_errors(folder, os.path.join(prefix, "zip_errors.c")))
    archives = [LIBRARIES[one].get("library", one) for one in (name, *needs)]
    defines = [f'-DLIBRARY_VERSION="{version}"', f"-DLIBRARY_CONFIG=0x{digest(include[0])}"] # the latter for the objects' names
    compiler.archive(os.path.join(prefix, f"lib{archives[0]}.a"), sources,
                     COMMON + row.get("flags", []) + defines + ["-I" + path for path in include])
    write_pkgconfig(prefix, name, version, include, archives)


def build_exceptions(compiler):
    """What throws and catches in C++ and jumps in C, from zig's own sources: those that it has built are without exceptions;
    and what stands in for a part of libc++."""
    lib = os.path.join(os.path.dirname(compiler.zig), "lib")
    flags = COMMON + ["-D_LIBCXXABI_BUILDING_LIBRARY", "-D_LIBCPP_BUILDING_LIBRARY", "-D_LIBCXXABI_HAS_NO_THREADS",
                      "-D_LIBUNWIND_HAS_NO_THREADS", "-D_LIBUNWIND_HIDE_SYMBOLS", "-fdeclspec",
                      f"-I{lib}/libcxxabi/include", f"-I{lib}/libcxx/src", f"-I{lib}/libunwind/include"]
    return [compiler.object(os.path.join(lib, "libcxxabi", "src", name + ".cpp"), flags)
            for name in ("cxa_exception", "cxa_personality", "stdlib_new_delete")] + [
        compiler.object(os.path.join(lib, "libunwind", "src", "Unwind-wasm.c"), flags),
        compiler.object(os.path.join(lib, "libc", "wasi", "libc-top-half", "musl", "src", "setjmp", "wasm32", "rt.c"), COMMON),
        compiler.object(os.path.join(HERE, "wasm", "decimals.cpp"), flags + ["-std=c++23"]),
        compiler.object(os.path.join(HERE, "wasm", "tags.s"), ["-mexception-handling"])]


def build_all(zig, place):
    """(folder for pkg-config, objects to link with); Lacking where Debian's sources cannot be had."""
    prefix = os.path.join(place, "prefix")
    os.makedirs(os.path.join(prefix, "pkgconfig"), exist_ok=True)
    os.makedirs(os.path.join(place, "sources"), exist_ok=True)
    compiler, debian = Compiler(zig, os.path.join(place, "objects")), Debian(os.path.join(place, "sources"))
    folders = {name: debian.source(row["package"]) for name, row in LIBRARIES.items()}
    for name in LIBRARIES:
        build_library(compiler, name, folders, prefix)
    return os.path.join(prefix, "pkgconfig"), build_exceptions(compiler)


def assets(place):
    """What a page has of them beside the module: the font's file, and the licences of all as one text."""
    debian = Debian(os.path.join(place, "sources"))
    font, licence = debian.font()
    papers = [(FONT, licence)] + [(name, os.path.join(debian.source(row["package"])[0], "debian", "copyright")) for name, row in LIBRARIES.items()]
    texts = []
    for name, path in papers:
        with open(path, encoding="utf-8") as file:
            texts.append(f"==== {name}\n\n{file.read().strip()}\n")
    return font, "\n".join(texts)
