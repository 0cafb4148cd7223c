# SPDX-License-Identifier: MIT
"""csgmesh batch --cache URL: results that machines share through a server that speaks the protocol of Bazel's remote caches.
With a server of our own that can be at fault in every way: then one warning, and everything is made as without it. With
nginx, where it is installed, as a server that others have written.
"""
import hashlib
import http.server
import json
import os
import socket
import subprocess
import threading
import time
import unittest

import cli
import nginx
from batch_support import BASE, BatchTest, MUG, digest, needs_hashes

SMALL = ["-r", "8"]
SCENES = ["mug.txt", "box.txt", "ball.txt"]


class Handler(http.server.BaseHTTPRequestHandler):
    """What the server of the test does; its `fault` names what it does wrong."""
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def log_message(self, *_): # pylint: disable=arguments-differ
        pass

    def answer(self, status, body=b"", length=None, **headers):
        self.send_response(status)
        for name, value in headers.items():
            self.send_header(name, value)
        self.send_header("Content-Length", str(len(body) if length is None else length))
        self.end_headers()
        self.wfile.write(body)

    def is_refused(self):
        server = self.server
        server.seen.append((self.command, self.path, self.headers.get("Authorization")))
        if server.password and self.headers.get("Authorization") != server.password:
            self.answer(401, b"who are you?")
            return True
        return False

    def hang(self):
        self.server.over.wait(30)
        self.close_connection = True

    def trickle(self, body):
        self.send_response(200)
        self.send_header("Content-Length", str(len(body) + 1000))
        self.end_headers()
        while not self.server.over.wait(0.05):
            self.wfile.write(b"x")
            self.wfile.flush()
        self.close_connection = True

    def flood(self):
        self.send_response(200)
        self.end_headers()
        self.close_connection = True
        while not self.server.over.is_set():
            self.wfile.write(b"x" * 65536)

    def is_at_fault(self, kind):
        """Does the fault concern this request? "cas: flipped" concerns /cas/ alone."""
        place, _, fault = (self.server.fault or "").rpartition(": ")
        return fault == kind and (not place or self.path.startswith(f"/{place}/"))

    def do_GET(self):
        if self.is_refused():
            return
        body = self.server.store.get(self.path)
        if self.is_at_fault("hang"):
            self.hang()
        elif self.is_at_fault("error"):
            self.answer(500, b"<html>it hurts</html>")
        elif self.is_at_fault("elsewhere"):
            self.answer(302, b"", Location="/other" + self.path)
        elif self.is_at_fault("nonsense"):
            self.answer(200, b"<html><body>Welcome to the router</body></html>")
        elif self.is_at_fault("flood"):
            self.flood()
        elif body is None:
            self.answer(404, b"there is none")
        elif self.is_at_fault("trickle"):
            self.trickle(body)
        elif self.is_at_fault("cut"):
            self.answer(200, body[:len(body) // 2], len(body))
            self.close_connection = True
        elif self.is_at_fault("short"):
            self.answer(200, body[:-1])
        elif self.is_at_fault("long"):
            self.answer(200, body + b"!")
        elif self.is_at_fault("flipped"):
            place = len(body) // 2
            self.answer(200, body[:place] + bytes([body[place] ^ 1]) + body[place + 1:])
        elif self.is_at_fault("empty"):
            self.answer(200)
        else:
            self.answer(200, body)

    def do_PUT(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if self.is_refused():
            return
        kind, _, name = self.path.lstrip("/").partition("/")
        if self.server.fault == "read only":
            self.answer(403, b"not you")
        elif self.server.fault == "full":
            self.answer(507)
        elif self.server.fault == "put: error":
            self.answer(500)
        elif self.server.fault == "put: hang":
            self.hang()
        elif kind == "cas" and hashlib.sha256(body).hexdigest() != name:
            self.answer(400, b"that is not its digest")
        else:
            self.server.keep(self.path, body)
            self.answer(200)


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Handler)
        self.store, self.seen, self.fault, self.password = {}, [], None, None
        self.most = None # entries, with the last of which it begins to fail
        self.over = threading.Event()
        self.url = f"http://127.0.0.1:{self.server_address[1]}"
        threading.Thread(target=self.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()  # else stop() waits 0.5 s

    def handle_error(self, *_): # clients that go away
        pass

    def keep(self, path, body):
        self.store[path] = body
        if len(self.store) == self.most:
            self.fault = "error"

    def stop(self):
        self.over.set()
        self.shutdown()
        self.server_close()


def fields(message):
    """The fields of a message of protocol buffers: [(number, value)]."""
    def varint(at):
        value = shift = 0
        while True:
            byte = message[at]
            value |= (byte & 127) << shift
            shift += 7
            at += 1
            if byte < 128:
                return value, at
    at, found = 0, []
    while at < len(message):
        tag, at = varint(at)
        value, at = varint(at)
        if tag & 7 == 2:
            found.append((tag >> 3, message[at:at + value]))
            at += value
        else:
            assert tag & 7 == 0, "an unexpected kind of field"
            found.append((tag >> 3, value))
    return found


@needs_hashes
@unittest.skipUnless(cli.has_library("libcurl"), "no libcurl in this build")
class RemoteTest(BatchTest):
    made = None # the outputs of SCENES, made once for all tests

    def setUp(self):
        super().setUp()
        self.scenes()
        self.server = Server()
        self.addCleanup(self.server.stop)
        self.environment = {"HOME": self.folder, "no_proxy": "*"}
        for name in ("CSGMESH_CACHE", "CSGMESH_CACHE_TOKEN", "NETRC"):
            os.environ.pop(name, None)
        if not RemoteTest.made:
            self.batch(*SCENES, "-d", "wanted", *SMALL)
            RemoteTest.made = self.outputs("wanted")
        self.wanted = digest(self.made)
        self.count = 0

    def run_with(self, *arguments, cache=None, scenes=None, wanted=None):
        """In a folder of its own; the outputs are right in any case."""
        self.count += 1
        folder = f"out{self.count}"
        options = ["--cache", cache or self.server.url] if cache != "" else []
        outcomes = self.batch(*(scenes or SCENES), "-d", folder, *SMALL, *options, *arguments, env=self.environment)
        self.assertEqual(digest(self.outputs(folder)), wanted or self.wanted)
        return outcomes[None]

    def fill(self):
        self.assertEqual(self.run_with()["made"], 3)
        self.assertEqual(self.messages, "")
        self.server.seen.clear()


class Protocol(RemoteTest):
    def test_another_machine(self):
        self.fill()
        self.assertEqual(self.run_with()["cached"], 3)
        self.assertEqual(self.messages, "")
        self.assertEqual({method for method, *_ in self.server.seen}, {"GET"})
        self.assertEqual(len(self.server.seen), 3 * 5) # two steps of a message and a text, and the output

    def test_the_protocol(self):
        """Names are SHA-256, messages are ActionResults of files that are there."""
        self.fill()
        for path, body in self.server.store.items():
            _, kind, name = path.split("/")
            self.assertRegex(name, "^[0-9a-f]{64}$")
            self.assertIn(kind, ("ac", "cas"))
            if kind == "ac":
                for number, file in fields(body):
                    self.assertEqual(number, 2)
                    sha256, size = (value for _, value in fields(dict(fields(file))[2]))
                    self.assertEqual(len(self.server.store["/cas/" + sha256.decode()]), size)
        self.assertNotIn(self.folder.encode(), b"".join(self.server.store.values()))

    def test_what_is_put_once_is_not_put_again(self):
        self.fill()
        self.run_with("--force")
        self.assertEqual(sum(path.startswith("/ac/") for method, path, _ in self.server.seen if method == "PUT"), 3)

    def test_inputs_count(self):
        """An include that changes, another one, and the first one again: each has its result."""
        self.fill()
        other = "module base(r) cube(r);\n"
        self.write("lib/base.txt", other)
        self.batch("mug.txt", "-d", "cube", *SMALL)
        cube = digest(self.outputs("cube"))
        self.assertEqual(self.run_with(scenes=["mug.txt"], wanted=cube)["made"], 1)
        self.assertEqual(self.run_with(scenes=["mug.txt"], wanted=cube)["cached"], 1)
        self.write("lib/base.txt", BASE)
        self.assertEqual(self.run_with()["cached"], 3)

    def test_other_files_of_the_same_text(self):
        """The same scene finds its include elsewhere: two lists under one key."""
        self.fill()
        os.makedirs(self.path("second/lib"))
        os.makedirs(self.path("third"))
        for name in ("second/mug.txt", "third/mug.txt"):
            self.write(name, MUG)
        self.write("second/lib/base.txt", "include <more.txt>\n" + BASE)
        self.write("second/lib/more.txt", "more = 1;\n")
        mug = {"mug.glb": self.wanted["mug.glb"]}
        self.assertEqual(self.run_with(scenes=["second/mug.txt"], wanted=mug)["made"], 1)
        self.assertEqual(self.run_with(scenes=["second/mug.txt"], wanted=mug)["cached"], 1)
        self.assertEqual(self.run_with(scenes=["mug.txt"], wanted=mug)["cached"], 1)
        self.assertEqual(self.run_with("-I", "lib", "-I", ".", scenes=["third/mug.txt"], wanted=mug)["made"], 1)
        self.assertEqual(self.run_with("-I", "lib", "-I", ".", scenes=["third/mug.txt"], wanted=mug)["cached"], 1)

    def test_many_at_once(self):
        names = self.many(40)
        self.batch(*names, "-d", "many", *SMALL)
        wanted = digest(self.outputs("many"))
        self.assertEqual(self.run_with("-j", "8", scenes=names, wanted=wanted)["made"], 40)
        self.assertEqual(self.run_with("-j", "8", scenes=names, wanted=wanted)["cached"], 40)
        self.assertEqual(self.messages, "")

    def test_environment(self):
        self.environment["CSGMESH_CACHE"] = self.server.url + "/"
        self.assertEqual(self.run_with(cache="")["made"], 3)
        self.assertEqual(self.run_with(cache="")["cached"], 3)
        self.environment["CSGMESH_CACHE"] = self.path("folder")
        self.assertEqual(self.run_with(cache="")["made"], 3)
        self.assertEqual(self.run_with(cache="")["cached"], 3)
        self.assertEqual(self.run_with()["cached"], 3) # the option wins

    def test_entries_that_are_gone(self):
        """As a server does that has little room."""
        self.fill()
        whole = dict(self.server.store)
        acts = {path for path in whole if path.startswith("/ac/")}
        for path in whole:
            self.server.store = {name: body for name, body in whole.items() if name != path}
            summary = self.run_with()
            self.assertEqual((summary["made"], summary["cached"], self.messages), (1, 2, ""))
            self.assertEqual(set(self.server.store) & acts, acts)


class Faults(RemoteTest):
    def assert_goes_on(self, words, *arguments, cache=None, shown=None, made=3):
        """words "": whatever the reason, which may be that it was too slow, and then this machine's, too."""
        patience = [] if words else ["--cache-timeout", "0.4"]
        summary = self.run_with(*patience, *arguments, cache=cache)
        self.assertEqual(self.messages.count("\n"), 1, self.messages)
        self.assertIn(f"csgmesh: warning: going on without the cache {shown or cache or self.server.url}: ", self.messages)
        self.assertIn(words, self.messages)
        if made is not None:
            self.assertEqual(summary["made"], made)

    def test_whatever_it_answers(self):
        self.fill()
        for fault, words, made in (
                ("error", "it answers 500", 3), ("elsewhere", "it answers 302", 3), ("nonsense", "no result of an action", 3),
                ("hang", "", 3), ("ac: trickle", "", 3), ("ac: cut", "", 3), ("ac: short", "no result of an action", 3),
                ("ac: flipped", "", None), ("ac: empty", "no result of an action", 3), ("flood", "more than an entry", 3),
                ("cas: error", "it answers 500", 3), ("cas: hang", "", 3), ("cas: cut", "", 3), ("cas: trickle", "", 3),
                ("cas: nonsense", "do not have the digest", 3), ("cas: short", "do not have the digest", 3),
                ("cas: long", "more than an entry", 3), ("cas: flipped", "do not have the digest", 3),
                ("cas: empty", "do not have the digest", 3), ("cas: flood", "more than an entry", 3)):
            with self.subTest(fault):
                self.server.fault = fault
                if fault == "ac: flipped": # another digest, which the server does not have; or none
                    self.assertEqual(self.run_with()["made"], 3)
                else:
                    self.assert_goes_on(words, made=made)
        self.server.fault = None
        self.assertEqual(self.run_with()["cached"], 3) # nothing has been spoilt

    def test_outputs_at_fault(self):
        """Texts are right, and an output is not."""
        self.fill()
        whole = dict(self.server.store)
        outputs = {hashlib.sha256(content).hexdigest() for content in self.made.values()}
        for change in (lambda body: body[:-1], lambda body: body + b"!", lambda body: body[:-1] + bytes([body[-1] ^ 1]),
                       lambda body: b"", lambda body: b"<html></html>", lambda body: body[:100] + b"?" + body[101:]):
            self.server.store = {path: change(body) if path[5:] in outputs else body for path, body in whole.items()}
            self.assert_goes_on("do not have the digest of their name", made=None)

    def test_messages_at_fault(self):
        """Any byte of a message below /ac/ may be wrong."""
        self.fill()
        whole = dict(self.server.store)
        for path in sorted(path for path in whole if path.startswith("/ac/")):
            for place in range(0, len(whole[path]), 92 // cli.rounds(4)):
                body = whole[path]
                self.server.store = {**whole, path: body[:place] + bytes([body[place] ^ 0x11]) + body[place + 1:]}
                self.assertGreaterEqual(self.run_with("-j", "1")["made"], 1)

    def test_storing(self):
        for fault, words in (("put: error", "it answers 500"), ("put: hang", "")):
            self.server.fault = fault
            self.assert_goes_on(words)
        for fault, status in (("read only", 403), ("full", 507)):
            self.server.fault = fault
            self.assertEqual(self.run_with()["made"], 3)
            self.assertEqual(self.messages, f"csgmesh: warning: the cache {self.server.url} takes nothing from here: it answers "
                             f"{status}\n")
        self.server.fault = None
        self.fill()
        self.server.fault = "read only"
        self.assertEqual((self.run_with()["cached"], self.messages), (3, ""))

    def test_no_server(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.assert_goes_on("onnect", cache=f"http://127.0.0.1:{free.getsockname()[1]}")
        self.assert_goes_on("", cache="http://cache.invalid/x")
        self.assert_goes_on("", cache="https://" + self.server.url[7:]) # it speaks no TLS
        self.assert_goes_on("", cache="http://127.0.0.1:123456")

    def test_no_address(self):
        for cache in ("http://", "http:///x", "http://a/?b", "http://a/#b"):
            self.run_with(cache=cache)
            self.assertEqual(self.messages, "csgmesh: warning: no cache over HTTP: this is no address of a cache\n")

    def test_no_http(self):
        """Something that answers, but in another language."""
        listener = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(listener.close)

        def serve():
            while True:
                try:
                    connection, _ = listener.accept()
                    connection.recv(1000)
                    connection.sendall(b"220 mail.example.org ESMTP\r\n" * 20)
                    connection.close()
                except OSError:
                    return
        threading.Thread(target=serve, daemon=True).start()
        self.assert_goes_on("", cache=f"http://127.0.0.1:{listener.getsockname()[1]}")

    def test_it_goes_away(self):
        names = self.many(30, text="union(blend = 0.1) {{ sphere(r = {r}); cube([{r}, 2, {n}]); }}\n")
        self.batch(*names, "-d", "many", "-r", "8")
        wanted = digest(self.outputs("many"))
        self.server.most = 60 # five for each scene: two threads have stored at least ten whole ones
        self.run_with("-j", "2", scenes=names, wanted=wanted)
        self.assertEqual(self.messages.count("warning"), 1)
        self.server.fault = None
        self.assertGreater(self.run_with(scenes=names, wanted=wanted)["cached"], 5)

    def test_interrupt(self):
        self.server.fault = "hang"
        process = subprocess.Popen([cli.PROGRAM, "batch", *SCENES, "-d", "out", *SMALL, "--cache", self.server.url],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while not self.server.seen:
            time.sleep(0.001)
        process.terminate()
        process.communicate(timeout=20)
        self.assertNotEqual(process.returncode, 0)
        self.assertEqual(self.outputs("out"), {})

    def test_quiet(self):
        self.server.fault = "error"
        self.run_with("-q")
        self.assertEqual(self.messages, "")


class Credentials(RemoteTest):
    """Taken from the address, ~/.netrc, $NETRC and the environment; never printed."""
    USER = "Basic bWU6czNjcjN0" # me:s3cr3t

    def check(self, password, cache=None):
        self.server.password = password
        self.server.store.clear()
        self.assertEqual(self.run_with(cache=cache)["made"], 3)
        self.assertEqual(self.messages, "")
        self.assertEqual(self.run_with(cache=cache)["cached"], 3)
        self.assertEqual({header for *_, header in self.server.seen}, {password})
        self.server.fault = "error"
        self.count += 1
        result = self.run_in("batch", *SCENES, "-d", f"out{self.count}", *SMALL, "--json", "--junit", "failing.xml",
                             *(["--cache", cache or self.server.url]), env=self.environment)
        self.assertIn("going on without", result.stderr)
        self.assertNotIn("s3cr3t", result.stderr + result.stdout.decode() + self.read("failing.xml").decode())
        self.server.fault = None

    def test_in_the_address(self):
        self.check(self.USER, self.server.url.replace("//", "//me:s3cr3t@"))
        self.check(self.USER, self.server.url.replace("//", "//me:s3cr%33t@"))

    def test_token(self):
        self.environment["CSGMESH_CACHE_TOKEN"] = "s3cr3t"
        self.check("Bearer s3cr3t")

    def test_netrc(self):
        entry = "machine 127.0.0.1 login me password s3cr3t\n"
        self.write(".netrc", entry)
        self.check(self.USER)
        os.rename(self.path(".netrc"), self.path("elsewhere"))
        self.environment["NETRC"] = self.path("elsewhere")
        self.check(self.USER)

    def test_none(self):
        self.server.password = self.USER
        self.run_with()
        self.assertIn("it answers 401", self.messages)
        self.assertEqual(self.messages.count("\n"), 1)


@unittest.skipUnless(nginx.PROGRAM, "no nginx")
class Nginx(RemoteTest):
    """A server as Bazel's manual sets it up: nginx with files that may be put."""

    def test_nginx(self):
        address, process = nginx.serve(self.folder)
        self.addCleanup(process.communicate)
        self.addCleanup(process.terminate)
        if process.poll() is not None:
            self.skipTest("nginx does not start: " + process.communicate()[1].decode())
        url = address + "/csgmesh"
        self.assertEqual((self.run_with(cache=url)["made"], self.messages), (3, ""))
        self.assertEqual((self.run_with(cache=url)["cached"], self.messages), (3, ""))
        kinds = {name.split(os.sep)[1] for name in self.outputs("served") if name.startswith("csgmesh")}
        self.assertEqual(kinds, {"ac", "cas"})


@unittest.skipIf(cli.has_library("libcurl"), "this build has libcurl")
class WithoutCurl(BatchTest):
    def test_it_says_so(self):
        self.scenes()
        self.assert_refused(self.run_in("batch", *SCENES, "-d", "out", "--cache", "http://127.0.0.1:1"), 2, "without lib")
        self.assertFalse(os.path.exists(self.path("out")))
        self.assertIn("without libcurl", json.dumps(self.run_in("--version").stdout.decode()))


if __name__ == "__main__":
    cli.main()
