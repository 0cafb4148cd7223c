# SPDX-License-Identifier: MIT
"""The installed package: its files, the names that the shared library exports, and the example built
against it with pkg-config, dynamically and statically.

CSGMESH_BUILD names the build folder, CSGMESH_CC the C compiler, CSGMESH_CC_ARGS what it must be given
to link with this build (sanitizers).
"""
import glob
import os
import shlex
import shutil
import subprocess
import unittest

import cli

BUILD = os.environ["CSGMESH_BUILD"]
EXAMPLE = os.environ["CSGMESH_EXAMPLE"]


@unittest.skipUnless(shutil.which("pkg-config"), "pkg-config is not installed")
class Package(cli.CliTest):
    def setUp(self):
        super().setUp()
        subprocess.run(["meson", "install", "-C", BUILD, "--no-rebuild", "--quiet", "--destdir",
                        self.folder], check=True, capture_output=True)
        found = glob.glob(self.path("**/pkgconfig/csgmesh.pc"), recursive=True)
        self.assertEqual(len(found), 1, "no csgmesh.pc")
        self.env = {**os.environ, "PKG_CONFIG_SYSROOT_DIR": self.folder,
                    "PKG_CONFIG_PATH": os.path.dirname(found[0])}
        self.libraries = os.path.dirname(os.path.dirname(found[0]))

    def pkg_config(self, *arguments):
        text = subprocess.run(["pkg-config", *arguments, "csgmesh"], env=self.env, check=True,
                              capture_output=True, text=True).stdout
        return shlex.split(text)

    def build_and_run(self, *link):
        command = [*shlex.split(os.environ["CSGMESH_CC"]), EXAMPLE, "-std=c99", "-Wall", "-Werror",
                   *self.pkg_config("--cflags"), *link,
                   *shlex.split(os.environ.get("CSGMESH_CC_ARGS", "")), "-o", self.path("example")]
        built = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(built.returncode, 0, built.stderr)
        result = subprocess.run([self.path("example"), self.path("ball.ply")], capture_output=True,
                                text=True, check=False,
                                env={**self.env, "LD_LIBRARY_PATH": self.libraries})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"^[1-9]\d{3,} triangles\n$")
        self.assertEqual(self.info("ball.ply")["mesh"]["components"], 1)

    def test_shared(self):
        self.build_and_run(*self.pkg_config("--libs"))

    def test_static(self):
        archive = os.path.join(self.libraries, "libcsgmesh.a")
        others = [word for word in self.pkg_config("--libs", "--static") if word != "-lcsgmesh"]
        self.build_and_run(archive, *others)

    def test_version_and_program(self):
        self.assertEqual(self.pkg_config("--modversion"),
                         [cli.run("--version").stdout.split()[1].decode()])
        program = glob.glob(self.path("**/bin/csgmesh"), recursive=True)[0]
        subprocess.run([program, "--version"], check=True, capture_output=True)

    @unittest.skipUnless(shutil.which("nm"), "nm is not installed")
    def test_exported_names(self):
        library = os.path.join(self.libraries, "libcsgmesh.so")
        lines = subprocess.run(["nm", "-D", "--defined-only", library], check=True,
                               capture_output=True, text=True).stdout.splitlines()
        names = [line.split()[-1] for line in lines]
        self.assertGreater(len(names), 30)
        self.assertEqual([name for name in names if not name.startswith("csgm_")], [])
        with open(glob.glob(self.path("**/csgmesh.h"), recursive=True)[0],
                  encoding="utf-8") as header:
            text = header.read()
        self.assertEqual([name for name in names if f"{name}(" not in text], [])
        declared = set(cli.re.findall(r"CSGM_API [^;]*?\b(csgm_\w+)\(", text))
        self.assertEqual(declared - set(names), set(), "declared and not exported")


if __name__ == "__main__":
    cli.main()
