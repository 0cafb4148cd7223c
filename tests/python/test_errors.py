# SPDX-License-Identifier: MIT
"""What goes wrong: one exception each, which says what, where and what to do."""
import os
import pathlib
import signal
import subprocess
import sys
import textwrap
import threading
import _thread

import numpy as np
import pytest

import csgmesh
from conftest import ENDLESS

BALL = "sphere(10);"


def test_a_diagnostic_has_its_place_and_hint(folder):
    (folder / "s.txt").write_text("cube(1);\n  spere(2);\n  cilinder(h = 1);\n")
    with pytest.raises(csgmesh.SceneError) as caught:
        csgmesh.load("s.txt")
    error = caught.value
    assert (error.file, error.line, error.column, error.code) == ("s.txt", 2, 3, error.diagnostics[0].code)
    assert error.hint == "did you mean 'sphere'?" and "spere" in error.message and error.source_line == "  spere(2);"
    assert "^~~~~" in str(error) and "hint: did you mean 'sphere'?" in str(error) and "more error" in str(error)
    assert [d.line for d in error.diagnostics if d.severity == "error"] == [2, 3]
    assert error.diagnostics[0].end_column == 8 and error.code.startswith("E0")
    with pytest.raises(csgmesh.SceneSyntaxError) as caught:
        csgmesh.parse("cube(1;", name="here.txt")
    assert caught.value.file == "here.txt" and caught.value.line == 1 and caught.value.column == 7


def test_warnings_are_warnings():
    text = "union(blend = 3) { sphere(1); translate([50, 0, 0]) sphere(1); }"
    with pytest.warns(csgmesh.SceneWarning, match="W0304") as caught:
        scene = csgmesh.parse(text)
    assert caught[0].filename == __file__  # the line that called
    assert caught[0].message.diagnostic.line == 1 and scene.diagnostics[0].severity == "warning"
    with pytest.raises(csgmesh.SceneError, match="W0304|E0304"):
        csgmesh.parse(text, warnings_as_errors=True)


def test_check(folder, recwarn):
    (folder / "s.txt").write_text("cube(1);\nspere(2);\ncilinder(3);\n")
    assert [(d.code, d.line) for d in csgmesh.check(pathlib.Path("s.txt"))] == [("E0201", 2), ("E0201", 3)]
    found = csgmesh.check("union(blend = 3) { sphere(1); translate([50, 0, 0]) sphere(1); }")
    assert [d.code for d in found] == ["W0304"]
    assert csgmesh.check(BALL) == csgmesh.check(csgmesh.sphere(1)) == []
    found = csgmesh.check(csgmesh.tube([[0, 0, 0]], degree=7))
    assert found[0].severity == "error" and found[0].made_at.startswith(__file__)
    assert not recwarn.list
    with pytest.raises(TypeError, match="no option 'only_check'"):
        csgmesh.parse(BALL, only_check=True)


@pytest.mark.parametrize("kind, call", [
    (TypeError, lambda: csgmesh.check(3)),
    (TypeError, lambda: csgmesh.mesh(3)),
    (TypeError, lambda: csgmesh.mesh(None)),
    (ValueError, lambda: csgmesh.mesh("parts/a.txt")),
    (TypeError, lambda: csgmesh.parse(b"cube(1);")),
    (TypeError, lambda: csgmesh.load(7)),
    (TypeError, lambda: csgmesh.mesh(BALL, resolution="fine")),
    (TypeError, lambda: csgmesh.mesh(BALL, resolution=2.5)),
    (TypeError, lambda: csgmesh.mesh(BALL, resolution=True)),
    (ValueError, lambda: csgmesh.mesh(BALL, resolution=-1)),
    (ValueError, lambda: csgmesh.mesh(BALL, resolution=2**40)),
    (TypeError, lambda: csgmesh.mesh(BALL, tolerance="0.1")),
    (ValueError, lambda: csgmesh.mesh(BALL, tolerance=float("nan"))),
    (TypeError, lambda: csgmesh.mesh(BALL, colors="yes")),
    (TypeError, lambda: csgmesh.mesh(BALL, quality=1)),
    (ValueError, lambda: csgmesh.mesh(BALL, quality="best")),
    (ValueError, lambda: csgmesh.mesh(BALL, bounds=[0, 0, 0, 1, 1, 1])),
    (TypeError, lambda: csgmesh.mesh(BALL, bounds=["abc", "def"])),
    (csgmesh.ArgumentError, lambda: csgmesh.mesh(BALL, tolerance=0.1, simplify_share=0.5)),
    (TypeError, lambda: csgmesh.mesh(BALL, progress=3)),
    (TypeError, lambda: csgmesh.mesh(BALL, define=["r=3"])),
    (ValueError, lambda: csgmesh.mesh(BALL, define={"r = 3; x": 1})),
    (TypeError, lambda: csgmesh.mesh(BALL, define={"r": object()})),
    (ValueError, lambda: csgmesh.parse(BALL, openscad_version="2021")),
    (TypeError, lambda: csgmesh.mesh(csgmesh.parse(BALL), define={"r": 1})),
    (ValueError, lambda: csgmesh.mesh(BALL).write("a.xyz")),
    (ValueError, lambda: csgmesh.mesh(BALL).write("a\0.ply")),
    (ValueError, lambda: csgmesh.mesh(BALL).write("a.bin", format="xyz")),
    (csgmesh.FileError, lambda: csgmesh.mesh(BALL).write("no/such/folder/a.ply")),
    (FileNotFoundError, lambda: csgmesh.load("missing.txt")),
    (csgmesh.MissingFileError, lambda: csgmesh.read("missing.ply")),
    (FileNotFoundError, lambda: csgmesh.mesh(pathlib.Path("missing.txt"))),
    (FileNotFoundError, lambda: csgmesh.diff("missing.ply", csgmesh.sphere(1))),
    (csgmesh.LimitError, lambda: csgmesh.parse(ENDLESS, max_steps=1000)),
    (csgmesh.LimitError, lambda: csgmesh.parse(ENDLESS, timeout=0.01)),
    (MemoryError, lambda: csgmesh.mesh(BALL, resolution=200, max_memory=2_000_000)),
    (ValueError, lambda: csgmesh.Mesh(np.zeros((4, 2)), [[0, 1, 2]])),
    (ValueError, lambda: csgmesh.Mesh(np.zeros((4, 3)), [0, 1, 2])),
    (ValueError, lambda: csgmesh.Mesh(np.zeros((2, 3)), [[0, 1, 2]])),
    (ValueError, lambda: csgmesh.Mesh(np.zeros((4, 3)), [[0, 1, -2]])),
    (TypeError, lambda: csgmesh.Mesh(np.zeros((4, 3)), [[0, 1, 2.5]])),
    (TypeError, lambda: csgmesh.Mesh([["a", "b", "c"]], [[0, 0, 0]])),
    (ValueError, lambda: csgmesh.Mesh(np.zeros((4, 3)), [[0, 1, 2]], normals=np.zeros((3, 3)))),
    (ValueError, lambda: csgmesh.Mesh(np.zeros((4, 3)), [[0, 1, 2]], colors=np.zeros((4, 3), np.uint8))),
    (ValueError, lambda: csgmesh.Mesh(np.zeros((4, 3)), [[0, 1, 2]], parts=[("a", 0, 5)])),
    (TypeError, lambda: csgmesh.parse(BALL).field([["a", "b", "c"]])),
    (ValueError, lambda: csgmesh.render(BALL, background="red!")),
    (ValueError, lambda: csgmesh.render(BALL, slice=("w", 1))),
    (csgmesh.ArgumentError, lambda: csgmesh.render(BALL, width=0)),
    (ValueError, lambda: csgmesh.diff(csgmesh.sphere(1), csgmesh.sphere(1), ignore="weather")),
    (TypeError, lambda: csgmesh.Scene()),
    (ValueError, lambda: csgmesh.parse(BALL, isa="sse9")),
])
def test_one_clear_exception(kind, call):
    with pytest.raises(kind) as caught:
        call()
    text = str(caught.value)
    assert len(text) > 10 and "bad_cast" not in text and "incompatible function arguments" not in text
    assert not isinstance(caught.value, csgmesh.InternalError)


def test_messages_name_what_is_wrong(folder):
    for text, call in (
            ("there is no option|no option 'resolutoin': did you mean 'resolution'", lambda: csgmesh.mesh(BALL, resolutoin=3)),
            ("quality must be 'normal', 'draft' or 'fine', not 'best'", lambda: csgmesh.mesh(BALL, quality="best")),
            ("tolerance must be a number, not '0.1'", lambda: csgmesh.mesh(BALL, tolerance="0.1")),
            (r"vertices must have the shape \(n, 3\), not \(4, 2\)", lambda: csgmesh.Mesh(np.zeros((4, 2)), [[0, 1, 2]])),
            ("No such file or directory: 'missing.txt'", lambda: csgmesh.load("missing.txt"))):
        with pytest.raises(Exception, match=text):
            call()
    with pytest.raises(FileNotFoundError) as caught:
        csgmesh.read("missing.ply")
    assert caught.value.filename == "missing.ply" and caught.value.errno == 2
    (folder / "broken.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")
    with pytest.raises(csgmesh.FormatError) as caught:
        csgmesh.read("broken.ply")
    assert caught.value.file == "broken.ply" and isinstance(caught.value, ValueError)
    (folder / "s.txt").write_text(BALL)
    with pytest.raises(ValueError, match="csgmesh.load reads scenes"):
        csgmesh.read("s.txt")


# ---- leaving a call

class Enough(Exception):
    pass


@pytest.mark.parametrize("call", [
    lambda progress: csgmesh.mesh("union(blend = 1) { sphere(9); cube(12); }", resolution=4000, progress=progress),
    lambda progress: csgmesh.write("union(blend = 1) { sphere(9); cube(12); }", "x.ply", resolution=4000, progress=progress),
    lambda progress: csgmesh.render("union(blend = 1) { sphere(9); cube(12); }", width=16000, height=16000, progress=progress),
], ids=["mesh", "write", "render"])
def test_progress_that_raises_ends_the_call(folder, call):
    seen = []

    def progress(stage, fraction):
        seen.append((stage, fraction))
        if len(seen) == 2:
            raise Enough
    with pytest.raises(Enough):
        call(progress)
    assert len(seen) == 2 and all(0 <= fraction <= 1 for _, fraction in seen)
    assert seen[0][0] in ("octree", "mesh", "write", "render")
    assert not list(folder.iterdir())


def test_progress_moves_a_bar_of_tqdm():
    tqdm = pytest.importorskip("tqdm")
    with open(os.devnull, "w", encoding="utf-8") as nowhere, tqdm.tqdm(total=100, file=nowhere) as bar:
        csgmesh.mesh(BALL, resolution=150, progress=bar)
        assert bar.n == 100
    with open(os.devnull, "w", encoding="utf-8") as nowhere, tqdm.tqdm(file=nowhere) as bar:
        csgmesh.mesh(BALL, resolution=20, progress=bar)
        assert bar.n == 1


def test_echo():
    lines = []
    csgmesh.parse('echo("one"); echo(2); sphere(1);', echo=lines.append)
    assert "".join(lines) == 'ECHO: "one"\nECHO: 2\n'
    csgmesh.parse("echo(1); sphere(1);", echo=None)

    def fails(text):
        raise Enough(text)
    with pytest.raises(Enough, match="ECHO"):
        csgmesh.parse("echo(1);" + ENDLESS, echo=fails)


def resident_bytes():
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="resident memory is looked up in /proc")
def test_a_callback_that_raises_leaks_nothing():
    """The scene holds its text, so that each scene that is lost is a megabyte."""
    text = "echo(1); sphere(1); //" + "x" * 1_000_000

    def fails(line):
        raise Enough(line)

    def parse(times):
        for _ in range(times):
            with pytest.raises(Enough):
                csgmesh.parse(text, echo=fails)
    parse(5)
    before = resident_bytes()
    parse(60)
    assert resident_bytes() - before < 25_000_000


def test_echo_is_printed(capsys):
    csgmesh.parse("echo(5); sphere(1);")
    assert capsys.readouterr().out == "ECHO: 5\n"


@pytest.mark.parametrize("call", [
    lambda: csgmesh.parse(ENDLESS),
    lambda: csgmesh.mesh("union(blend = 1) { sphere(9); cube(12); }", resolution=8000),
    lambda: csgmesh.parse("union(blend = 1) { sphere(9); cube(12); }").field(np.zeros((20_000_000, 3))),
    lambda: csgmesh.render("union(blend = 1) { sphere(9); cube(12); }", width=16000, height=16000),
], ids=["scene", "mesh", "field", "render"])
def test_an_interrupted_call(call):
    """The other thread runs, so the GIL is free; what it does is what Ctrl-C does."""
    timer = threading.Timer(0.1, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        call()
    timer.join()
    assert len(csgmesh.mesh(BALL, resolution=8).triangles)  # and all goes on


def test_ctrl_c_in_a_program():
    program = textwrap.dedent(f"""
        import csgmesh
        csgmesh.parse('echo("begun");' + {ENDLESS!r}, echo=lambda text: print(text, end="", flush=True))
    """)
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == 'ECHO: "begun"\n'
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=60)
    assert "KeyboardInterrupt" in errors and child.returncode == -signal.SIGINT


def test_threads_of_python():
    """Many at once, on one scene."""
    scene = csgmesh.parse("union(blend = 1) { sphere(9); cube(12); }")
    want = scene.mesh(resolution=20)
    found = []

    def work():
        mesh = scene.mesh(resolution=20, threads=2)
        found.append(np.array_equal(mesh.vertices, want.vertices) and np.array_equal(mesh.triangles, want.triangles))
    workers = [threading.Thread(target=work) for _ in range(8)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert found == [True] * 8
