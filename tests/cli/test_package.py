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

    def test_pages_scenes_and_examples(self):
        """All of docs, scenes and integrations is there, and the pages' links to each other hold."""
        source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
        share = os.path.dirname(os.path.dirname(glob.glob(self.path("**/doc/csgmesh"), recursive=True)[0]))
        pages = os.path.join(share, "doc", "csgmesh")
        for folder in ("docs", "scenes"):
            for place, _, names in os.walk(os.path.join(source, folder)):
                for name in names:
                    there = os.path.join(pages, os.path.relpath(os.path.join(place, name), source))
                    self.assertEqual(os.path.exists(there), name != "meson.build", there)
        for name in ("README.md", "CHANGELOG.md", "LICENSE"):
            self.assertTrue(os.path.exists(os.path.join(pages, name)), name)
        for name in ("batch.schema.json", "make/csgmesh.mk", "meson/csgmesh/meson.build", "github/csgmesh/action.yml"):
            self.assertTrue(os.path.exists(os.path.join(share, "csgmesh", name)), name)
        scene = os.path.join(pages, "scenes", "parts", "mug.txt")
        self.assert_status(self.run_in(scene, "-r", "16", "-q", "-o", "mug.ply"), 0)

    def test_pages_of_the_manual_and_completions(self):
        """They are what this program says of itself, where shells and man look for them."""
        share = os.path.dirname(os.path.dirname(glob.glob(self.path("**/doc/csgmesh"), recursive=True)[0]))
        names = cli.re.findall(r"csgmesh\\-(\w+) \(1\)", cli.run("man").stdout.decode())
        self.assertIn("mesh", names)
        said = {f"man/man1/csgmesh-{name}.1": ["man", name] for name in names}
        said["man/man1/csgmesh.1"] = ["man"]
        said["bash-completion/completions/csgmesh"] = ["completion", "bash"]
        said["zsh/site-functions/_csgmesh"] = ["completion", "zsh"]
        said["fish/vendor_completions.d/csgmesh.fish"] = ["completion", "fish"]
        for name, arguments in said.items():
            with open(os.path.join(share, name), "rb") as file:
                self.assertEqual(file.read(), cli.run(*arguments).stdout, name)

    @unittest.skipUnless(shutil.which("readelf"), "readelf is not installed")
    def test_soname_and_version_node(self):
        library = os.path.join(self.libraries, "libcsgmesh.so")
        dynamic = subprocess.run(["readelf", "-d", library], check=True, capture_output=True, text=True).stdout
        self.assertIn("soname: [libcsgmesh.so.0]", dynamic)
        symbols = subprocess.run(["readelf", "-W", "--dyn-syms", library], check=True, capture_output=True,
                                 text=True).stdout
        exported = cli.re.findall(r"(?:FUNC|OBJECT)\s+GLOBAL\s+DEFAULT\s+\d+\s+(\S+)", symbols)
        ours = [name for name in exported if name.startswith("csgm_")]
        self.assertGreater(len(ours), 30)
        self.assertEqual([name for name in ours if not name.endswith("@@CSGMESH_0")], [])
        self.assertIn("csgm_format_traits@@CSGMESH_0", ours)

    @unittest.skipUnless(shutil.which("nm"), "nm is not installed")
    def test_exported_names(self):
        library = os.path.join(self.libraries, "libcsgmesh.so")
        lines = subprocess.run(["nm", "-D", "--defined-only", library], check=True,
                               capture_output=True, text=True).stdout.splitlines()
        names = [line.split()[-1].split("@")[0] for line in lines if " A " not in line]
        self.assertGreater(len(names), 30)
        self.assertEqual([name for name in names if not name.startswith("csgm_")], [])
        folder = os.path.dirname(glob.glob(self.path("**/csgmesh.h"), recursive=True)[0])
        text = ""
        for name in sorted(os.listdir(folder)):
            with open(os.path.join(folder, name), encoding="utf-8") as header:
                text += header.read()
        self.assertEqual([name for name in names if f"{name}(" not in text], [])
        declared = set(cli.re.findall(r"CSGM_API [^;]*?\b(csgm_\w+)\(", text))
        self.assertEqual(declared - set(names), set(), "declared and not exported")


if __name__ == "__main__":
    cli.main()
