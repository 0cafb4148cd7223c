# SPDX-License-Identifier: MIT
"""A client of the language server: requests and answers over pipes, of Python's standard library alone."""
import json
import pathlib
import queue
import subprocess
import threading

import cli


class Client:
    """One server. Findings are kept by URI, each with the version of the text that they are of."""

    def __init__(self, *arguments, cwd=None, env=None, initialize=True, encodings=None, snippets=False):
        self.process = subprocess.Popen([cli.PROGRAM, "lsp", *arguments], cwd=cwd, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, env=env)
        self.messages = queue.Queue()
        self.findings = {}
        self.next_id = 0
        self.version = 0
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        if initialize:
            general = {"positionEncodings": encodings} if encodings else {}
            items = {"completion": {"completionItem": {"snippetSupport": snippets}}}
            self.capabilities = self.ask("initialize", {"capabilities": {"general": general, "textDocument": items}})["capabilities"]
            self.tell("initialized", {})

    def _read(self):
        out = self.process.stdout
        while True:
            length = None
            while True:
                line = out.readline()
                if not line:
                    self.messages.put(None)
                    return
                if line == b"\r\n":
                    break
                if line.startswith(b"Content-Length: "):
                    length = int(line[16:])
            self.messages.put(json.loads(out.read(length)))

    def send_bytes(self, data):
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.send_bytes(b"Content-Length: %d\r\n\r\n" % len(body) + body)

    def tell(self, method, params):
        self.send({"method": method, "params": params})

    def receive(self, timeout=60):
        """The next message that is no finding."""
        while True:
            message = self.messages.get(timeout=timeout)
            if message is None:
                raise EOFError("the server has ended")
            if message.get("method") != "textDocument/publishDiagnostics":
                return message
            self.findings[message["params"]["uri"]] = message["params"]

    def call(self, method, params):
        """The whole answer, with "result" or "error"."""
        self.next_id += 1
        self.send({"id": self.next_id, "method": method, "params": params})
        while True:
            message = self.receive()
            if message.get("id") == self.next_id:
                return message

    def ask(self, method, params):
        answer = self.call(method, params)
        if "error" in answer:
            raise AssertionError(f"{method}: {answer['error']}")
        return answer["result"]

    def open(self, path, text):
        """Opens a document; returns its URI."""
        uri = pathlib.Path(path).as_uri()
        self.version += 1
        self.tell("textDocument/didOpen", {"textDocument": {"uri": uri, "languageId": "csgmesh", "version": self.version, "text": text}})
        return uri

    def change(self, uri, text, change_range=None):
        self.version += 1
        change = {"text": text, **({"range": change_range} if change_range else {})}
        self.tell("textDocument/didChange", {"textDocument": {"uri": uri, "version": self.version}, "contentChanges": [change]})

    def wait_for_findings(self, uri):
        """Those of the latest text."""
        while self.findings.get(uri, {}).get("version") != self.version:
            message = self.messages.get(timeout=60)
            if message is None:
                raise EOFError("the server has ended")
            if message.get("method") == "textDocument/publishDiagnostics":
                self.findings[message["params"]["uri"]] = message["params"]
        return self.findings[uri]["diagnostics"]

    def stop(self):
        """Shuts the server down; its exit status and what it wrote to standard error."""
        self.ask("shutdown", None)
        self.tell("exit", None)
        return self.end()

    def kill(self):
        """Whatever it does; also after its end."""
        self.process.kill()
        self.process.wait()
        self.reader.join(60)
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            try:
                pipe.close()
            except BrokenPipeError:
                pass

    def end(self):
        self.process.stdin.close()
        status = self.process.wait(timeout=60)
        self.reader.join(60)
        error = self.process.stderr.read().decode()
        self.process.stdout.close()
        self.process.stderr.close()
        return status, error


def place(text, mark, within=0):
    """The position of `mark` in a text, `within` characters further on (all of it plain ASCII)."""
    offset = text.index(mark) + within
    line = text.count("\n", 0, offset)
    return {"line": line, "character": offset - (text.rfind("\n", 0, offset) + 1)}


def at(uri, text, mark, within=0):
    return {"textDocument": {"uri": uri}, "position": place(text, mark, within)}
