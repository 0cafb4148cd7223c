# SPDX-License-Identifier: MIT
"""tools/package and tools/packaging: one version, a source archive of the same bytes each time, recipes that their
languages can read (where these are installed). What takes minutes, the packages themselves, is in the checklist of
tools/packaging/README.md.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
PACKAGING = os.path.join(ROOT, "tools", "packaging")


def text_of(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


class InACopy(unittest.TestCase):
    """Of the files that tools/package reads; no clone, so that nothing depends on git."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.outer = os.path.realpath(folder.name)
        self.folder = os.path.join(self.outer, "copy")
        for name in ("meson.build", "CHANGELOG.md", "LICENSE", "include/csgmesh/csgmesh.h", "tools/package",
                     "tools/setup.sh"):
            os.makedirs(os.path.dirname(os.path.join(self.folder, name)), exist_ok=True)
            shutil.copy2(os.path.join(ROOT, name), os.path.join(self.folder, name))
        shutil.copytree(PACKAGING, os.path.join(self.folder, "tools/packaging"))

    def package(self, *arguments, status=0, path=""):
        result = subprocess.run([os.path.join(self.folder, "tools/package"), *arguments], capture_output=True, text=True,
                                check=False, env={**os.environ, "PATH": path + os.environ["PATH"],
                                                  "GIT_CEILING_DIRECTORIES": os.path.dirname(self.outer)})
        self.assertEqual(result.returncode, status, result.stderr)
        return result.stdout if status == 0 else result.stderr

    def read(self, name, mode="r"):
        with open(os.path.join(self.folder, name), mode) as file:
            return file.read()

    def test_version(self):
        now = self.package("version").strip()
        self.assertEqual(now, re.search(r"^  version: '(.*)',$", text_of("meson.build"), re.M).group(1))
        self.package("version", "12.34.56")
        self.assertEqual(self.package("version"), "12.34.56\n")
        header = self.read("include/csgmesh/csgmesh.h")
        self.assertEqual(re.findall(r"#define CSGM_VERSION_\w+ (\d+)", header), ["12", "34", "56"])
        self.assertIn('/* "12.34.56"; static storage', header)
        for bad in ("1.2", "v1.2.3", "1.2.3-rc1", ""):
            self.assertIn("a version is three numbers", self.package("version", bad, status=2))
        self.assertEqual(self.package("version"), "12.34.56\n")

    def test_unknown_words(self):
        self.assertIn("there is no package 'rpm'", self.package("rpm", status=2))
        self.assertIn("wants the URL", self.package("homebrew", status=2))
        self.assertIn("tools/package deb", self.package())

    def test_source_and_formula(self):
        for name in ("build/a.o", "build-test/b.o", ".git/config", "tests/io/node_modules/c.js"):
            os.makedirs(os.path.dirname(os.path.join(self.folder, name)), exist_ok=True)
            with open(os.path.join(self.folder, name), "w", encoding="utf-8"):
                pass
        self.package("source")
        version = self.package("version").strip()
        archive = f"build-package/csgmesh-{version}.tar.gz"
        first = self.read(archive, "rb")
        with tarfile.open(os.path.join(self.folder, archive)) as tar:
            names = tar.getnames()
            self.assertEqual({(member.uid, member.gid) for member in tar}, {(0, 0)})
        self.assertIn(f"csgmesh-{version}/meson.build", names)
        self.assertEqual([name for name in names if re.search(r"\.o$|\.git/|node_modules|build-package", name)], [])
        for name in ("meson.build", "tools"): # times of files and folders are not those of the commit
            os.utime(os.path.join(self.folder, name), (1, 1))
        self.package("source")
        self.assertEqual(self.read(archive, "rb"), first)
        self.package("homebrew", f"https://example.org/releases/csgmesh-{version}.tar.gz")
        formula = self.read("build-package/csgmesh.rb")
        self.assertNotIn("@", formula.replace("https://", ""))
        self.assertIn(f'version "{version}"', formula)
        self.assertIn('homepage "https://example.org/releases"', formula)
        if shutil.which("sha256sum"):
            sum_of = subprocess.run(["sha256sum", os.path.join(self.folder, archive)], capture_output=True, text=True,
                                    check=True).stdout.split()[0]
            self.assertIn(f'sha256 "{sum_of}"', formula)
        if shutil.which("ruby"):
            subprocess.run(["ruby", "-c", os.path.join(self.folder, "build-package/csgmesh.rb")], check=True,
                           capture_output=True)

    def names_in_archive(self):
        with tarfile.open(os.path.join(self.folder, f"build-package/csgmesh-{self.package('version').strip()}.tar.gz")) as tar:
            return {name.split("/", 1)[1] for name in tar.getnames()}

    def git(self, folder, *arguments):
        subprocess.run(["git", "-C", folder, *arguments], check=True, capture_output=True)

    @unittest.skipUnless(shutil.which("git"), "git is not installed")
    def test_source_within_another_repository(self):
        self.package("source")
        alone = self.names_in_archive()
        self.git(self.outer, "init")
        with open(os.path.join(self.outer, "theirs"), "w", encoding="utf-8"):
            pass
        self.git(self.outer, "add", "theirs")
        self.git(self.outer, "-c", "user.name=a", "-c", "user.email=a@example.org", "commit", "-m", "theirs")
        os.utime(os.path.join(self.folder, "CHANGELOG.md"), (1000000, 1000000))
        self.package("source")
        self.assertEqual(self.names_in_archive(), alone)
        version = self.package("version").strip()
        with tarfile.open(os.path.join(self.folder, f"build-package/csgmesh-{version}.tar.gz")) as tar:
            self.assertEqual({member.mtime for member in tar}, {1000000}) # not that of their commit

    @unittest.skipUnless(shutil.which("git"), "git is not installed")
    def test_source_of_a_clone(self):
        self.git(self.folder, "init")
        error = self.package("source", status=2)
        self.assertEqual(error.count("error:"), 1, error)
        self.assertIn("meson.build is not among the sources", error)
        self.assertEqual([name for name in os.listdir(os.path.join(self.folder, "build-package")) if name.endswith("gz")], [])
        for name in ("größe.csg", "unknown"):
            with open(os.path.join(self.folder, name), "w", encoding="utf-8"):
                pass
        self.git(self.folder, "add", "meson.build", "größe.csg")
        self.package("source")
        self.assertEqual(self.names_in_archive(), {"meson.build", "größe.csg"})

    def test_a_failed_archive_replaces_none(self):
        self.package("source")
        archive = f"build-package/csgmesh-{self.package('version').strip()}.tar.gz"
        first = self.read(archive, "rb")
        for name in ("tar", "gzip"):
            folder = os.path.join(self.outer, "no-" + name)
            os.mkdir(folder)
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write("#!/bin/sh\necho half\nexit 1\n")
            os.chmod(os.path.join(folder, name), 0o755)
            self.assertIn(f"{name} could not", self.package("source", status=2, path=folder + ":"))
            self.assertEqual(self.read(archive, "rb"), first)

    def test_any_url(self):
        self.package("homebrew", "https://example.org/a&b|c\\d\"#{e}/get?x=1&y=2")
        formula = self.read("build-package/csgmesh.rb")
        inside = 'https://example.org/a&b|c\\\\d\\"\\#{e}'  # as Ruby wants it within quotes
        self.assertIn(f'url "{inside}/get?x=1&y=2"', formula)
        self.assertIn(f'homepage "{inside}"', formula)


class BillOfMaterials(unittest.TestCase):
    """tools/packaging/sbom.py; tests/cli/test_usage.py holds the one of the build against --version."""

    def made(self, *rows, **environment):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bill.json")
            subprocess.run([sys.executable, os.path.join(PACKAGING, "sbom.py"), path, "1.2.3", "cc 1", *rows], check=True,
                           env={**os.environ, **environment})
            with open(path, encoding="utf-8") as file:
                return json.load(file)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for name, needs in (("first", "second >= 2"), ("second", "third"), ("third", "")):
            with open(os.path.join(folder.name, name + ".pc"), "w", encoding="utf-8") as file:
                file.write(f"Name: {name}\nDescription: a test\nVersion: 4.5\nRequires.private: {needs}\n")
        self.environment = {"PKG_CONFIG_LIBDIR": folder.name, "SOURCE_DATE_EPOCH": ""}

    @unittest.skipUnless(shutil.which("pkg-config"), "pkg-config is not installed")
    def test_what_libraries_need(self):
        rows = ("First|4.5|meshes|first", "Odd|6|names|found without", "First|4.5|pictures|first")
        bill = self.made(*rows, **self.environment)
        self.assertEqual({c["bom-ref"]: (c["name"], c["version"], c.get("description")) for c in bill["components"]},
                         {"first": ("First", "4.5", "meshes; pictures"), "second": ("second", "4.5", None),
                          "third": ("third", "4.5", None), "found without": ("Odd", "6", "names")})
        self.assertEqual({row["ref"]: row["dependsOn"] for row in bill["dependencies"]},
                         {"csgmesh": ["first", "found without"], "first": ["second"], "second": ["third"], "third": [],
                          "found without": []})
        self.assertEqual(self.made(*rows, **self.environment), bill, "the same build has the same bytes")
        self.assertNotEqual(self.made(*rows[:2], **self.environment)["serialNumber"], bill["serialNumber"])
        self.assertNotIn("timestamp", bill["metadata"])
        dated = self.made(*rows, **{**self.environment, "SOURCE_DATE_EPOCH": "86400"})
        self.assertEqual(dated["metadata"]["timestamp"], "1970-01-02T00:00:00Z")


class Recipes(unittest.TestCase):
    def test_debian_builds_with_what_tools_run_installs(self):
        ours = set(re.findall(r"[\w.+-]+-dev\b", re.search(r"need_packages gcc.*?\"\$@\"", text_of("tools/setup.sh"),
                                                           re.S).group(0)))
        control = text_of("tools/packaging/debian/control")
        theirs = set(re.findall(r"[\w.+-]+-dev\b", re.search(r"Build-Depends:(.*?)\nStandards", control, re.S).group(1)))
        self.assertGreater(len(ours), 10)
        self.assertEqual(theirs, ours)
        soversion = re.search(r"soversion: '(\d+)'", text_of("src/api/meson.build")).group(1)
        self.assertIn(f"\nPackage: libcsgmesh{soversion}\n", control)
        for package in re.findall(r"^Package: (\S+)", control, re.M):
            self.assertTrue(os.path.exists(os.path.join(PACKAGING, "debian", f"{package}.install")), package)

    def test_the_readme_names_what_there_is(self):
        for page in ("README.md", "tools/packaging/README.md"):
            for word in re.findall(r"tools/package (\w+)", text_of(page)):
                self.assertIn(f"\n{word})", text_of("tools/package"), page)

    @unittest.skipUnless(shutil.which("nix-instantiate"), "nix-instantiate is not installed")
    def test_nix(self):
        subprocess.run(["nix-instantiate", "--parse", os.path.join(PACKAGING, "nix/default.nix")], check=True,
                       capture_output=True)

    @unittest.skipUnless(shutil.which("hadolint"), "hadolint is not installed")
    def test_dockerfile(self):
        subprocess.run(["hadolint", os.path.join(PACKAGING, "Dockerfile")], check=True)

    @unittest.skipUnless(shutil.which("shellcheck"), "shellcheck is not installed")
    def test_scripts(self):
        for name in ("package", "run"): # with what they source
            subprocess.run(["shellcheck", "--severity=warning", "-s", "sh", "-x", "-P", os.path.join(ROOT, "tools"),
                            os.path.join(ROOT, "tools", name)], check=True)


if __name__ == "__main__":
    unittest.main()
