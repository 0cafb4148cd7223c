# SPDX-License-Identifier: MIT
"""csgmesh view: what its server answers, that it follows files, and the page itself in headless Chromium (tools/view
has the driver; without it those tests are skipped).
"""
import http.client
import json
import os
import shutil
import signal
import socket
import struct
import subprocess
import time
import unittest
from urllib.parse import urlsplit

import cli

HERE = os.path.dirname(os.path.abspath(__file__))
VIEW = os.path.join(HERE, "../../tools/view")
CHROMIUM = os.environ.get("CSGMESH_CHROMIUM", "/usr/bin/chromium")
HAS_BROWSER = (os.path.isdir(os.path.join(VIEW, "node_modules/playwright-core"))
               and os.access(CHROMIUM, os.X_OK) and shutil.which("node") is not None)
needs_browser = unittest.skipUnless(HAS_BROWSER, "no Chromium, or no npm ci --prefix tools/view")

PLATE = """/* [Plate] */
width = 30; // [10:60]
label = "lid"; // what stands on it
echo(width);
difference() { cube([width, 20, 10]); #translate([15, 10, -1]) cylinder(h = 12, r = 5); }
%translate([0, 0, 15]) sphere(3);
"""


class Running:
    """A csgmesh view that is at work, and what its page would ask."""

    def __init__(self, folder, *arguments):
        self.program = subprocess.Popen([cli.PROGRAM, "view", *map(str, arguments), "--no-open"], cwd=folder,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.url = self.program.stdout.readline().decode().strip()
        self.address = urlsplit(self.url)
        self.version = 0

    def ask(self, method, path, body=None, host=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.address.port, timeout=120)
        try:
            connection.request(method, path, body=body, headers={"Host": host} if host else {})
            response = connection.getresponse()
            return response.status, response.read(), response.headers
        finally:
            connection.close()

    def get(self, path):
        return self.ask("GET", self.address.path + path)

    def set(self, lines):
        return self.ask("POST", self.address.path + "set", lines.encode())[0]

    def wait(self, *phases):
        """The next state that is in one of these phases."""
        while True:
            status, body, _ = self.get(f"state?after={self.version}")
            if status == 204:
                continue
            state = json.loads(body)
            self.version = state["version"]
            if state["scene"]["phase"] in phases:
                return state

    def model(self, number):
        """Header, and the bytes behind it; None: it is gone."""
        status, body, _ = self.get(f"model?number={number}")
        if status != 200:
            return None
        length = struct.unpack_from("<I", body)[0]
        return json.loads(body[4:4 + length]), body[4 + length:]

    def end(self, number=signal.SIGINT):
        if self.program.poll() is None:
            self.program.send_signal(number)
        out, err = self.program.communicate(timeout=120)
        return self.program.returncode, out.decode(), err.decode()


class ViewTest(cli.CliTest):
    def setUp(self):
        super().setUp()
        if not cli.has_library("libmicrohttpd"):
            self.skipTest("this build has no libmicrohttpd")
        self.running = None

    def start(self, *arguments):
        self.running = Running(self.folder, *arguments)
        self.addCleanup(self.running.end, signal.SIGKILL)
        self.assertRegex(self.running.url, r"^http://127\.0\.0\.1:\d+/[0-9a-f]{32}/$")
        return self.running

    def until(self, width):
        """The first state whose solid is so wide: a file that is half written may be shown before."""
        while True:
            state = self.running.wait("done")
            bounds = self.bounds(state)
            if bounds and abs(bounds[0][1] - width) < 1e-3:
                return state

    def bounds(self, state):
        """None: the model is empty, or there is a later one."""
        header, data = self.running.model(state["scene"]["model"]) or ({"layers": [{"vertices": 0}]}, b"")
        layer = header["layers"][0]
        if not layer["vertices"]:
            return None
        places = struct.unpack_from(f"<{3 * layer['vertices']}f", data, layer["positions"])
        return [(min(places[k::3]) + layer["origin"][k], max(places[k::3]) + layer["origin"][k]) for k in range(3)]


class Server(ViewTest):
    def test_formats(self):
        """What the page offers is what this build writes."""
        self.write("plate.scad", PLATE)
        running = self.start("plate.scad")
        state = running.wait("done")
        self.assertEqual(state["formats"], cli.formats_written())
        self.assertEqual(state["drawings"], ["svg", "dxf", "pdf"] if cli.has_library("Clipper") else [])
        status, body, _ = running.get("file?format=svg") # of a solid: refused in any case, and the words say why
        self.assertEqual((status, b"no such format" in body), (404, not state["drawings"]))

    def test_state_and_model(self):
        self.write("plate.scad", PLATE)
        running = self.start("plate.scad")
        state = running.wait("done")
        self.assertEqual(state["scene"]["name"], "plate.scad")
        self.assertEqual([row["name"] for row in state["parameters"]], ["width", "label"])
        self.assertEqual(state["parameters"][0]["max"], 60)
        self.assertIn("ECHO: 30", state["findings"][0]["echo"])
        for (low, high), (least, most) in zip(self.bounds(state), [(0, 30), (0, 20), (0, 10)]):
            self.assertAlmostEqual(low, least, delta=0.02)
            self.assertAlmostEqual(high, most, delta=0.02)
        header, data = running.model(state["scene"]["model"])
        self.assertEqual([layer["kind"] for layer in header["layers"]], ["solid", "highlight", "background"])
        self.assertEqual(header["layers"][0]["triangles"], state["scene"]["mesh"]["triangles"])
        last = header["layers"][-1]
        self.assertEqual(last["indices"] + 12 * last["triangles"], len(data))
        for layer in header["layers"]:
            corners = struct.unpack_from(f"<{3 * layer['triangles']}I", data, layer["indices"])
            self.assertEqual(max(corners) + 1, layer["vertices"])
        self.assertIsNone(running.model(state["scene"]["model"] + 1))
        status, out, err = running.end()
        self.assertEqual((status, out), (0, ""))
        self.assertIn("Ctrl-C ends it", err)

    def test_follows_files(self):
        """A saved change, one of an include, a new file in the old one's place, an error, a file that is gone."""
        self.write("size.scad", "size = 10;\n")
        self.write("main.scad", "include <size.scad>\ncube(size);\n")
        running = self.start("main.scad")
        self.until(10)
        self.write("size.scad", "size = 12;\n")
        self.until(12)
        self.write("new", "include <size.scad>\ncube(size + 1);\n")
        os.replace(self.path("new"), self.path("main.scad"))
        self.until(13)
        self.write("main.scad", "cube(;\n")
        state = running.wait("failed")
        self.assertEqual((state["findings"][0]["line"], state["findings"][0]["severity"]), (1, "error"))
        self.assertIsNotNone(running.model(state["scene"]["model"]), "the model before the error stays")
        os.remove(self.path("main.scad"))
        finding = running.wait("failed")["findings"][0]
        self.assertEqual((finding["file"], finding["severity"]), ("main.scad", "error"))
        self.write("main.scad", "cube(5);\n")
        self.until(5)
        self.assertEqual(running.end(signal.SIGTERM)[0], 0)

    def test_what_was_missing_comes(self):
        self.write("main.txt", "include <later.txt>\ncube(size);\n")
        running = self.start("main.txt")
        running.wait("failed")
        self.write("later.txt", "size = 4;\n")
        self.until(4)

    def test_what_is_wrong_or_missing_elsewhere(self):
        """Files of other folders, from the start: what does not parse, what an assertion refuses, what is not there."""
        os.mkdir(self.path("lib"))
        self.write("lib/size.txt", "size = ;\n")
        self.write("main.txt", "include <lib/size.txt>\nassert(size < 9);\ncube(size);\n")
        running = self.start("main.txt")
        self.assertEqual(running.wait("failed")["findings"][0]["code"], "E0108")
        self.write("lib/size.txt", "size = 10;\n")
        while running.wait("failed")["findings"][0]["code"] == "E0108":
            pass
        self.write("lib/size.txt", "include <more.txt>\nsize = more;\n")
        while running.wait("failed")["findings"][0]["code"] != "E0122":
            pass
        self.write("lib/more.txt", "more = 4;\n")
        self.until(4)

    def test_what_was_missing_and_only_warned_of_comes(self):
        self.write("main.scad", "include <later.scad>\ncube(4);\n")
        self.start("main.scad")
        self.until(4)
        self.write("later.scad", "translate([6, 0, 0]) cube(4);\n")
        self.until(10)

    def test_values(self):
        """Those of the page win over -D; a wrong one is a finding, and the next one is taken."""
        self.write("plate.scad", PLATE)
        running = self.start("plate.scad", "-D", "width=40")
        self.until(40)
        self.assertEqual(running.set('width=50\nlabel="a\\nb"'), 204)
        state = self.until(50)
        self.assertEqual([row.get("value") for row in state["parameters"]], [50, "a\nb"])
        self.assertEqual(running.set("width"), 204)
        self.assertIn("NAME=EXPR", running.wait("failed")["findings"][0]["message"])
        self.assertEqual(running.set(""), 204)
        self.until(40)
        self.assertEqual(running.set("a=" + "1" * 100000), 413)

    def test_mesh(self):
        self.write("ball.txt", cli.BALL)
        self.run_in("ball.txt", "-o", "ball.ply", "-r", 16)
        running = self.start("ball.ply")
        self.assertAlmostEqual(self.bounds(running.wait("done"))[0][1], 1, delta=0.01)

    def test_who_may_ask(self):
        self.write("ball.txt", cli.BALL)
        running = self.start("ball.txt")
        path, port = running.address.path, running.address.port
        status, page, headers = running.get("")
        self.assertEqual(status, 200)
        self.assertIn(b"class SolidView extends View", page)
        self.assertNotIn(b"{{", page)
        self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
        self.assertEqual(running.ask("GET", path, host=f"localhost:{port}")[0], 200)
        for host in ("evil.example", f"evil.example:{port}", f"127.0.0.1:{port + 1}", "127.0.0.1"):
            self.assertEqual(running.ask("GET", path, host=host)[0], 403, host)
        for wrong in ("/", "/state", path[:-2] + "/", path.upper() + "x", "/" + "0" * 32 + "/state"):
            self.assertEqual(running.ask("GET", wrong)[0], 404, wrong)
        for method in ("PUT", "DELETE", "POST"):
            self.assertEqual(running.ask(method, path + "state")[0], 404, method)
        self.assertEqual(running.ask("GET", path + "../../../etc/passwd")[0], 404)
        with socket.create_connection(("127.0.0.1", port)) as nonsense:
            nonsense.sendall(b"\x00\xff nonsense\r\n\r\n")
        self.assertEqual(running.get("")[0], 200)

    def test_long_work_is_given_up(self):
        """A change is shown although the mesh before it would take minutes; so is the end."""
        self.write("main.scad", cli.ENDLESS)
        running = self.start("main.scad", "--max-steps", "1e15")
        running.wait("reading")
        self.write("main.scad", "cube(5);\n")
        running.wait("done")
        self.write("main.scad", cli.ENDLESS)
        running.wait("reading")
        self.assertEqual(running.end()[0], 0)


class Files(ViewTest):
    """The scene as a file: what csgmesh mesh writes."""

    def file(self, name, words=None):
        status, body, headers = self.running.get(f"file?format={name}")
        if words is not None:
            self.assertEqual(status, 404)
            self.assertIn(words, body.decode())
            return None
        self.assertEqual(status, 200, body)
        self.assertEqual(headers["Content-Type"], "application/octet-stream")
        return body, headers["Content-Disposition"]

    def written(self, scene, name, *arguments):
        self.assert_status(self.run_in(scene, "-o", name, *arguments), 0)
        return self.read(name)

    def test_bytes_of_the_command_line(self):
        self.write("a plate.scad", PLATE)
        self.start("a plate.scad", "-D", "label=\"x\"", "--quality", "draft")
        self.until(30)
        options = ("-D", "label=\"x\"", "--quality", "draft")
        for name in ("stl", "glb", "obj", "ply", "off"):
            body, disposition = self.file(name)
            self.assertEqual(body, self.written("a plate.scad", f"want.{name}", *options), name)
            self.assertEqual(disposition, f"attachment; filename*=UTF-8''a%20plate.{name}")
        self.running.set("width=45")
        self.until(45)
        self.assertEqual(self.file("stl")[0], self.written("a plate.scad", "wide.stl", *options, "-D", "width=45"))

    def test_formats(self):
        """Those of the state are all that this build writes."""
        self.write("ball.txt", cli.BALL)
        self.start("ball.txt", "--quality", "draft")
        state = self.running.wait("done")
        self.assertTrue({"stl", "glb", "gltf", "obj", "ply", "off"} <= set(state["formats"]), state["formats"])
        for name in state["formats"]:
            self.assertEqual(self.file(name)[0], self.written("ball.txt", f"want.{name}", "--quality", "draft"), name)
        for name in state["drawings"]:
            self.file(name, "flat")
        for name in ("", "doc", "../stl", "auto"):
            self.file(name, "no such format")

    def test_flat_scene_and_mesh(self):
        self.write("flat.scad", "difference() { square([30, 20]); translate([9, 9]) circle(4); }\n")
        self.start("flat.scad")
        for name in self.running.wait("done")["drawings"]:
            self.assertEqual(self.file(name)[0], self.written("flat.scad", f"want.{name}"), name)
        self.assertEqual(self.file("stl")[0], self.written("flat.scad", "want.stl"))
        self.running.end()
        self.start("want.stl")
        self.running.wait("done")
        self.assertEqual(self.file("glb")[0], self.written("want.stl", "want.glb"))

    def test_confined(self):
        self.write("ball.txt", cli.BALL)
        self.start("ball.txt", "--root", ".")
        self.running.wait("done")
        self.assertEqual(self.file("stl")[0], self.written("ball.txt", "want.stl"))

    def test_what_stands_in_the_way(self):
        self.write("main.scad", "cube(;\n")
        self.start("main.scad")
        self.running.wait("failed")
        self.file("stl", "main.scad:1:6: error")
        self.write("main.scad", "cube(5);\n")
        self.until(5)
        self.file("stl")
        os.remove(self.path("main.scad"))
        self.file("stl", "No such file")

    def test_the_end_does_not_wait_for_it(self):
        self.write("main.scad", "if (is_undef(slow)) cube(5); else { " + cli.ENDLESS + " }\n")
        self.start("main.scad", "--max-steps", "1e15")
        self.running.wait("done")
        self.running.set("slow=1")
        self.running.wait("reading")
        with socket.create_connection(("127.0.0.1", self.running.address.port)) as asking:
            asking.sendall(f"GET {self.running.address.path}file?format=stl HTTP/1.1\r\n"
                           f"Host: {self.running.address.netloc}\r\n\r\n".encode())
            self.assertEqual(self.running.get("file?format=none")[0], 404)
            self.assertEqual(self.running.end()[0], 0)


class Faults(ViewTest):
    def refused(self, status, words, *arguments):
        self.assert_refused(self.run_in("view", *arguments, "--no-open"), status, words)

    def test_command_line(self):
        self.write("ball.txt", cli.BALL)
        self.refused(2, "no scene given")
        self.refused(2, "one scene", "ball.txt", "ball.txt")
        self.refused(2, "standard input", "-")
        self.refused(2, "cannot read none.txt", "none.txt")
        self.refused(2, "65535", "ball.txt", "--port", 70000)
        self.refused(2, "-r and -s", "ball.txt", "-r", 8, "-s", 1)

    def test_busy_port(self):
        self.write("ball.txt", cli.BALL)
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = other.getsockname()[1]
            self.refused(2, f"port {port} is in use", "ball.txt", "--port", port)


@needs_browser
class Page(ViewTest):
    def look(self, size, *steps, refusals=()):
        """refusals: answers of the server that the browser counts as errors."""
        result = subprocess.run(["node", os.path.join(HERE, "look_at_view.mjs"), self.running.url, size, *steps],
                                env={**os.environ, "CSGMESH_VIEW": VIEW}, capture_output=True, text=True, timeout=300,
                                check=False)
        if result.returncode:
            raise AssertionError(result.stderr)
        seen = json.loads(result.stdout)
        self.assertEqual([error for error in seen["errors"] if not any(f"status of {status}" in error for status in refusals)], [])
        return seen["looks"]

    def test_desktop(self):
        self.write("plate.scad", PLATE)
        self.start("plate.scad")
        broken = f"write={self.path('plate.scad')}=cube(10); sphere("
        first, cut, measured, wider, failed = self.look(
            "1280x800", "wait=done", "look", "section=x", "look", "from=top", "measure=0.33,0.5:0.36,0.45", "look",
            "set=width=60", "wait=done", "look", broken, "wait=failed", "look")
        self.assertEqual(first["title"], "plate.scad - csgmesh view")
        self.assertIn("30 x 20 x 10", first["figures"])
        self.assertIn("ECHO: 30", first["echo"])
        self.assertEqual(first["kinds"], ["solid", "highlight", "background"])
        self.assertGreater(first["drawn"], 0.05)
        self.assertGreater(first["red"], 0.001, "what is highlighted")
        self.assertEqual((first["cut"], first["status"], first["stale"]), (0, "", False))
        self.assertGreater(cut["cut"], 0.005)
        self.assertRegex(measured["length"], r"^\d")
        self.assertIn("60 x 20 x 10", wider["figures"])
        self.assertIn("E0108", failed["findings"])
        self.assertTrue(failed["stale"])
        self.assertIn("model before it", failed["status"])

    def test_edges(self):
        """The triangles' edges, on the solid and on what a section leaves of it, and none of them once the box is unchecked."""
        self.write("ball.txt", cli.BALL)
        self.start("ball.txt", "-r", 16)
        bare, edges, cut, cut_bare, after = self.look("1280x800", "wait=done", "look", "edges", "look", "section=x", "look", "no-edges", "look",
                                                      "section=none", "look")
        self.assertGreater(edges["dark"], bare["dark"] + 0.01)
        self.assertGreater(edges["dark"], 3 * bare["dark"])
        self.assertAlmostEqual(edges["drawn"], bare["drawn"], delta=0.005, msg="edges are drawn on the solid alone")
        self.assertGreater(cut["dark"], cut_bare["dark"])
        self.assertEqual(after["dark"], bare["dark"])

    def test_download(self):
        self.write("plate.scad", PLATE)
        self.start("plate.scad")
        self.look("1280x800", "wait=done", "set=width=50", "wait=done", f"download=stl={self.path('got.stl')}")
        self.run_in("plate.scad", "-o", "want.stl", "-D", "width=50")
        self.assertEqual(self.read("got.stl"), self.read("want.stl"))
        self.write("plate.scad", "cube(;\n")
        refused, = self.look("390x800", "wait=failed", "refused=stl", "look", refusals=(404,))
        self.assertIn("No file: plate.scad:1:6: error", refused["status"])

    def test_phone_and_keys(self):
        self.write("ball.txt", cli.BALL)
        self.start("ball.txt")
        first, nearer = self.look("390x800", "wait=done", "look", "key=+", "key=+", "key=+", "look")
        self.assertEqual(first["wide"], 390, "nothing is wider than the phone")
        self.assertGreater(nearer["drawn"], 1.3 * first["drawn"])


if __name__ == "__main__":
    cli.main()
