# SPDX-License-Identifier: MIT
"""The package as a whole: types for checkers, the page that shows a mesh, the examples of docs/python.md."""
import base64
import html
import importlib.resources
import json
import os
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

import csgmesh
from csgmesh import _page
from conftest import ROOT, csgmesh_program

EXAMPLES = re.findall(r"^```python\n(.*?)^```\n(?:\n^```text\n(.*?)^```\n)?", (ROOT / "docs" / "python.md").read_text(), re.S | re.M)


def test_there_are_twelve_examples():
    assert len(EXAMPLES) == 12


@pytest.mark.parametrize("code, output", EXAMPLES, ids=range(1, len(EXAMPLES) + 1))
def test_examples_of_the_manual(code, output, capsys, folder):
    if "trimesh" in code:
        pytest.importorskip("trimesh")
    (folder / "mug.txt").write_text((ROOT / "scenes" / "parts" / "mug.txt").read_text())
    exec(compile(code, "docs/python.md", "exec"), {"__name__": "__main__"})
    assert capsys.readouterr().out.rstrip() == output.rstrip()


def test_version_and_features():
    version = csgmesh_program("--version").decode()
    assert csgmesh.__version__ in version.splitlines()[0]
    assert all(line in version for line in csgmesh.features.splitlines())


def test_help_names_the_options():
    assert "simplify_share" in csgmesh.mesh.__doc__ and "define" in csgmesh.mesh.__doc__ and "progress" in csgmesh.read.__doc__
    assert "radius" in csgmesh.sphere.__doc__ and "only_check" not in csgmesh.check.__doc__


def test_types_are_there():
    files = importlib.resources.files("csgmesh")
    for name in ("py.typed", "_core.pyi", "_modules.py", "functions.py", "view.js"):
        assert (files / name).is_file()
    stub = (files / "_core.pyi").read_text()
    assert all(f"def {name}(" in stub for name in ("parse", "build", "diff", "eval_points", "render_scene"))


def test_a_type_checker_agrees(folder):
    pytest.importorskip("mypy")
    (folder / "use.py").write_text(
        "import csgmesh\nmesh = csgmesh.mesh('sphere(1);', tolerance=0.05)\nreveal_type(mesh.write('a.ply'))\n"
        "solid = (csgmesh.sphere(10) | csgmesh.cube(8)).fillet(2)\nreveal_type(solid)\ncsgmesh.mesh('', quality='best')\n")
    out = subprocess.run([sys.executable, "-m", "mypy", "--python-executable", sys.executable, "use.py"], capture_output=True, text=True, check=False).stdout
    assert 'Revealed type is "csgmesh._modules.Solid"' in out and "use.py:6: error" in out and out.count("error:") == 1, out


def page_data(page):
    return json.loads(re.search(r'id="data">(.*?)</script>', page, re.S).group(1))


def test_the_page_holds_the_mesh_and_needs_nothing():
    mesh = csgmesh.mesh('color("red") cube([4, 2, 1]);', resolution=8)
    page = mesh.to_html("a <title>")
    assert "<title>a &lt;title&gt;</title>" in page and "{{" not in page
    assert not re.search(r"https?://|<link[^>]+href=\"(?!data:)|src=|@import|fetch\(|XMLHttp", page)
    data = page_data(page)
    model = data["a"]
    steps = np.frombuffer(base64.b64decode(model["positions"]), "<u2").reshape(-1, 3)
    low, high = np.array(data["box"][:3]), np.array(data["box"][3:])
    assert np.allclose(low + steps / 65535 * (high - low), mesh.vertices, atol=1e-4)
    assert np.array_equal(np.frombuffer(base64.b64decode(model["indices"]), "<u4").reshape(-1, 3), mesh.triangles)
    assert np.array_equal(np.frombuffer(base64.b64decode(model["colors"]), np.uint8).reshape(-1, 3), mesh.colors[:, :3])
    assert (ROOT / "tools" / "csgmesh" / "page" / "view.js").read_text() in page


def test_in_a_notebook():
    mesh = csgmesh.mesh("sphere(3);", quality="draft")
    for shown in (mesh, csgmesh.sphere(3)):
        frame = shown._repr_html_()
        inner = html.unescape(re.fullmatch(r'<iframe sandbox="allow-scripts" [^>]*srcdoc="([^"]*)"></iframe>', frame, re.S).group(1))
        assert page_data(inner)["a"]["triangles"] == len(mesh.triangles)
    assert page_data(csgmesh.mesh("intersection() { cube(1); translate([5, 0, 0]) cube(1); }").to_html())["a"]["triangles"] == 0


def test_a_large_mesh_is_thinned_out(monkeypatch):
    mesh = csgmesh.mesh('color("red") sphere(3);', resolution=64)
    monkeypatch.setattr(_page, "MOST", 2000)
    inner = html.unescape(re.search('srcdoc="([^"]*)"', mesh._repr_html_()).group(1))
    model = page_data(inner)["a"]
    assert 500 < model["triangles"] <= 2000 and f"{len(mesh.triangles)} triangles (drawn with {model['triangles']})" in inner
    steps = np.frombuffer(base64.b64decode(model["positions"]), "<u2").reshape(-1, 3)
    indices = np.frombuffer(base64.b64decode(model["indices"]), "<u4").reshape(-1, 3)
    distances = np.linalg.norm((steps / 65535 - 0.5) * 6, axis=1)
    assert indices.max() < len(steps) and 2.7 < distances.min() and distances.max() < 3.01
    assert set(base64.b64decode(model["colors"])) == {0, 255}
    assert page_data(mesh.to_html())["a"]["triangles"] == len(mesh.triangles)


CHROMIUM = os.environ.get("CSGMESH_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
# What the page shows when it is there, and after keys: how much of it is drawn, and where the camera is.
LOOK = """<script>
const seen = [];
const look = () => {
  const gl = view.gl, pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  view.draw();
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let red = 0;
  for (let i = 0; i < pixels.length; i += 4) red += pixels[i] > 40 && pixels[i] > 3 * pixels[i + 1] && pixels[i] > 3 * pixels[i + 2];
  seen.push({ red: red / (pixels.length / 4), azimuth: view.camera.azimuth, distance: view.camera.distance });
};
const press = (key) => view.canvas.dispatchEvent(new KeyboardEvent("keydown", { key }));
look(); press("ArrowLeft"); look(); press("+"); look();
document.body.dataset.seen = JSON.stringify(seen);
</script></body>"""


@pytest.mark.skipif(not CHROMIUM, reason="no Chromium")
def test_the_page_in_a_browser(folder):
    page = csgmesh.mesh('color("red") sphere(3);', resolution=24).to_html()
    (folder / "page.html").write_text(page.replace("</body>", LOOK))
    out = subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--enable-unsafe-swiftshader", "--window-size=600,400", f"--user-data-dir={folder}/profile",
         "--virtual-time-budget=3000", "--dump-dom", f"file://{folder}/page.html"], capture_output=True, text=True, check=False)
    found = re.search('data-seen="([^"]*)"', out.stdout)
    if not found and "WebGL 2." in out.stdout:
        pytest.skip("this Chromium draws no WebGL 2")
    first, turned, nearer = json.loads(html.unescape(found.group(1)))
    assert 0.02 < first["red"] < 0.9 and turned["azimuth"] > first["azimuth"] and nearer["distance"] < turned["distance"]
    assert nearer["red"] > turned["red"]
