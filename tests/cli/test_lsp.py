# SPDX-License-Identifier: MIT
"""csgmesh lsp over its protocol: findings, names, layout, colours, and what it says to nonsense."""
import json
import os
import pathlib
import random
import unittest
import unittest.mock

import cli
from lsp_client import Client, at, place

MAIN = """use <wheel.txt>
include <sizes.txt>
// How many there are.
count = 4; // [1:9]
/* [Hidden] */
module cart(length, gap = 2) {
  for (i = [1 : count])
    translate([i * gap, 0, 0]) wheel(r = radius, width = 3);
  color("red") cube([length, 1, 1]);
}
function twice(x) = 2 * x;
cart(twice(5));
"""
WHEEL = """// A wheel with its axis along z.
// Its rim is round.
module wheel(r, width = 2) cylinder(h = width, r = r, round = rim);
rim = 0.5;
"""
SIZES = "radius = 7; // of all wheels\n"


class Lsp(cli.CliTest):
    def setUp(self):
        super().setUp()
        self.write("main.txt", MAIN)
        self.write("wheel.txt", WHEEL)
        self.write("sizes.txt", SIZES)

    def start(self, *arguments, **options):
        client = Client(*arguments, cwd=self.folder, **options)
        self.addCleanup(client.kill)
        return client

    def open_main(self):
        client = self.start()
        return client, client.open(self.path("main.txt"), MAIN)

    def uri(self, name):
        return pathlib.Path(self.path(name)).as_uri()


class Findings(Lsp):
    def test_as_one_types(self):
        client, uri = self.open_main()
        self.assertEqual(client.wait_for_findings(uri), [])
        client.change(uri, "cub(3);\n")
        found = client.wait_for_findings(uri)
        self.assertEqual([(f["code"], f["severity"]) for f in found], [("E0201", 1)])
        self.assertIn("did you mean 'cube'?", found[0]["message"])
        self.assertEqual(found[0]["range"], {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 3}})
        line = {"line": 0, "character": 3}
        client.change(uri, "e", {"start": line, "end": line})
        self.assertEqual(client.wait_for_findings(uri), [])
        client.tell("textDocument/didClose", {"textDocument": {"uri": uri}})
        self.assertEqual(client.stop(), (0, ""))

    def test_in_an_included_file(self):
        client = self.start()
        self.write("broken.txt", "sphere(;\n")
        uri = client.open(self.path("a.txt"), "cube(1);\ninclude <broken.txt>\n")
        found = client.wait_for_findings(uri)
        self.assertEqual(found[0]["range"]["start"]["line"], 1)
        self.assertIn("broken.txt:1:8", found[0]["message"])
        self.assertEqual(found[0]["relatedInformation"][0]["location"]["uri"], self.uri("broken.txt"))
        self.write("broken.txt", "sphere(1);\n")
        client.version += 1
        client.change(uri, "cube(1);\ninclude <broken.txt>\n")
        self.assertEqual(client.wait_for_findings(uri), [])

    def test_the_latest_text_wins(self):
        client = self.start()
        uri = client.open(self.path("a.txt"), cli.ENDLESS)
        for i in range(20):
            client.change(uri, cli.ENDLESS + f"// {i}\n")
        client.change(uri, "sphere(1) cube(2);\n")
        self.assertEqual([f["code"] for f in client.wait_for_findings(uri)], ["W0216"])
        client.change(uri, cli.ENDLESS)  # the end does not wait for it
        self.assertEqual(client.stop()[0], 0)

    def test_characters_of_the_editor(self):
        for encodings, column in ((None, 11), (["utf-16"], 11), (["utf-8", "utf-16"], 13)):
            client = self.start(encodings=encodings)
            uri = client.open(self.path("a.txt"), 'x = "\U0001F600a"; cub(1);\n')
            self.assertEqual(client.wait_for_findings(uri)[0]["range"]["start"]["character"], column, encodings)


    def test_a_text_with_a_nul(self):
        client = self.start()
        uri = client.open(self.path("a.txt"), 'x = 1;\0\ncub(1);\n')
        self.assertEqual(sorted((f["code"], f["range"]["start"]["line"]) for f in client.wait_for_findings(uri))[0], ("E0102", 0))
        client.change(uri, "", {"start": {"line": 0, "character": 6}, "end": {"line": 0, "character": 7}})
        self.assertEqual([(f["code"], f["range"]["start"]["line"]) for f in client.wait_for_findings(uri)], [("E0201", 1)])


class Names(Lsp):
    def test_hover(self):
        client, uri = self.open_main()
        value = client.ask("textDocument/hover", at(uri, MAIN, "wheel(r", 2))["contents"]["value"]
        self.assertIn("module wheel(r, width = 2)", value)
        self.assertIn("A wheel with its axis along z.", value)
        value = client.ask("textDocument/hover", at(uri, MAIN, "cube(", 1))["contents"]["value"]
        self.assertIn("module cube(size = 1, center = false, round = 0)", value)
        self.assertIn("radius of all edges and corners", value)
        value = client.ask("textDocument/hover", at(uri, MAIN, "count]", 1))["contents"]["value"]
        self.assertIn("count = 4", value)
        self.assertIn("How many there are.", value)
        value = client.ask("textDocument/hover", at(uri, MAIN, "radius", 1))["contents"]["value"]
        self.assertIn("of all wheels", value)
        self.assertIsNone(client.ask("textDocument/hover", at(uri, MAIN, "[1 :", 1)))

    def test_definition_through_use_and_include(self):
        client, uri = self.open_main()
        for mark, name, line in (("wheel(r", "wheel.txt", 2), ("radius", "sizes.txt", 0), ("count]", "main.txt", 3),
                                 ("gap, 0", "main.txt", 5), ("i * gap", "main.txt", 6), ("twice(5)", "main.txt", 10)):
            found = client.ask("textDocument/definition", at(uri, MAIN, mark))
            self.assertEqual([(f["uri"], f["range"]["start"]["line"]) for f in found], [(self.uri(name), line)], mark)
        found = client.ask("textDocument/definition", at(uri, MAIN, "width = 3"))
        self.assertEqual(found[0]["range"]["start"], place(WHEEL, "width"))
        self.assertEqual(client.ask("textDocument/definition", at(uri, MAIN, "cube(")), [])

    def test_references(self):
        client, uri = self.open_main()
        question = at(uri, MAIN, "gap = 2")
        found = client.ask("textDocument/references", question)
        self.assertEqual([f["range"]["start"] for f in found], [place(MAIN, "gap = 2"), place(MAIN, "gap, 0")])
        found = client.ask("textDocument/references", {**question, "context": {"includeDeclaration": False}})
        self.assertEqual(len(found), 1)
        found = client.ask("textDocument/references", at(uri, MAIN, "wheel(r"))
        self.assertEqual({f["uri"] for f in found}, {uri, self.uri("wheel.txt")})
        self.assertEqual(len(client.ask("textDocument/documentHighlight", at(uri, MAIN, "count = 4"))), 2)

    def test_files_that_changed_meanwhile(self):
        """What is not open is read again before its places are told, whichever file is asked about."""
        client = self.start()
        self.write("part.txt", "include <sizes.txt>\nmodule part() cube(radius);\n")
        text = "use <part.txt>\npart();\n"
        uri = client.open(self.path("a.txt"), text)
        client.ask("textDocument/definition", at(uri, text, "part();"))
        sizes = client.open(self.path("sizes.txt"), SIZES)
        question = {**at(sizes, SIZES, "radius"), "newName": "size"}
        self.assertEqual(client.ask("textDocument/rename", question)["changes"][self.uri("part.txt")][0]["range"]["start"]["line"], 1)
        self.write("part.txt", "include <sizes.txt>\n\n\nmodule part() cube(radius);\n")
        self.assertEqual(client.ask("textDocument/rename", question)["changes"][self.uri("part.txt")][0]["range"]["start"],
                         {"line": 3, "character": 19})

    def test_rename(self):
        client, uri = self.open_main()
        question = at(uri, MAIN, "wheel(r", 2)
        self.assertEqual(client.ask("textDocument/prepareRename", question)["start"], place(MAIN, "wheel(r"))
        changes = client.ask("textDocument/rename", {**question, "newName": "disc"})["changes"]
        self.assertEqual({name: [(e["newText"], e["range"]["start"]) for e in edits] for name, edits in changes.items()},
                         {uri: [("disc", place(MAIN, "wheel(r"))], self.uri("wheel.txt"): [("disc", place(WHEEL, "wheel(r"))]})
        for name in ("for", "2 x", "", "a-b"):
            self.assertIn("error", client.call("textDocument/rename", {**question, "newName": name}))
        self.assertIn("error", client.call("textDocument/rename", {**at(uri, MAIN, "cube("), "newName": "box"}))
        self.assertIsNone(client.ask("textDocument/prepareRename", at(uri, MAIN, "cube(")))

    def test_completion(self):
        client = self.start()
        text = MAIN + "whe"
        uri = client.open(self.path("main.txt"), text)

        def labels(mark, within):
            return {i["label"]: i for i in client.ask("textDocument/completion", at(uri, text, mark, within))["items"]}
        self.assertEqual(list(labels("\nwhe", 4)), ["wheel"])
        client.change(uri, text := MAIN + "wheel(")
        items = labels("\nwheel(", 7)
        self.assertEqual(items["width"]["insertText"], "width = ")
        self.assertTrue({"count", "radius", "twice", "sin", "PI", "undef"} <= set(items))
        self.assertNotIn("cart", items)
        self.assertIn("sine", items["sin"]["documentation"]["value"])
        client.change(uri, text := MAIN + "sphere(")
        self.assertEqual(labels("\nsphere(", 8)["d"]["documentation"]["value"].split("\n")[3], "diameter, instead of r")
        client.change(uri, text := MAIN + "module m(inner) { x = inn; translate([0, 0, 1]) cy }\n")
        self.assertEqual(list(labels("= inn;", 5)), ["inner"])
        self.assertIn("cylinder", labels(" cy }", 3))
        client.change(uri, text := MAIN + "// sph")
        self.assertEqual(labels("// sph", 6), {})

    def test_snippets(self):
        """What an editor fills in: for those that say so, and where no brackets stand yet."""
        text = ("module frame($gap, size, depth = 2) { children(); }\n/* children */ module peg(r) cylinder(h = 1, r = r);\n"
                "function half(x) = x / 2;\nfunction none() = 1;\n")
        client = self.start(snippets=True)
        uri = client.open(self.path("a.txt"), text)

        def snippet(written, label, at_column=None):
            whole = text + written
            client.change(uri, whole)
            position = {"line": whole.count("\n"), "character": len(written) if at_column is None else at_column}
            items = client.ask("textDocument/completion", {"textDocument": {"uri": uri}, "position": position})["items"]
            item = {i["label"]: i for i in items}[label]
            self.assertEqual("insertText" in item, "insertTextFormat" in item)
            return item.get("insertText")
        for written, label, want in (
                ("fra", "frame", r"frame(${1:\$gap}, ${2:size}) $0"), ("pe", "peg", "peg(${1:r});"), ("cub", "cube", "cube($1);"),
                ("trans", "translate", "translate($1) $0"), ("union() sph", "sphere", "sphere($1);"), ("chil", "children", "children();"),
                ("mod", "module", "module ${1:name}($2) {\n  $0\n}"), ("fo", "for", "for (${1:i} = [${2:0} : ${3:10}]) $0"),
                ("func", "function", "function ${1:name}($2) = $0;"), ("x = func", "function", "function (${1:x}) $0"),
                ("x = [fo", "for", "for (${1:i} = [${2:0} : ${3:10}]) $0"), ("ass", "assert", "assert(${1:condition});"),
                ("x = ass", "assert", "assert(${1:condition}) $0"), ("inc", "include", "include <$0>"),
                ("x = hal", "half", "half(${1:x})"), ("x = no", "none", "none()"), ("x = tru", "true", None), ("x = P", "PI", None)):
            self.assertEqual(snippet(written, label), want, written)
        self.assertEqual(snippet("cub;", "cube", 3), "cube($1)")
        self.assertIsNone(snippet("cub (3);", "cube", 2))
        client = self.start()
        uri = client.open(self.path("a.txt"), text)
        self.assertIsNone(snippet("cub", "cube"))

    def test_completion_of_paths(self):
        os.makedirs(self.path("lib/whole"))
        self.write("lib/whole/inner.scad", "")
        self.write("lib/whole/data.csv", "")
        client = self.start("-I", self.path("lib"))
        for text, want in (("use <whe", ["wheel.txt"]), ("include <whole/", ["inner.scad"]), ("use <wh", ["wheel.txt", "whole"]),
                           ("use <none/", []), ("x = 1 <whe", ["wheel.txt"][:0])):
            uri = client.open(self.path("a.txt"), text)
            items = client.ask("textDocument/completion", {"textDocument": {"uri": uri}, "position": {"line": 0, "character": len(text)}})["items"]
            self.assertEqual(sorted(i["label"] for i in items), want, text)

    def test_signature(self):
        client = self.start()
        text = MAIN + "wheel(1, [2, f(3)], "
        uri = client.open(self.path("main.txt"), text)
        shown = client.ask("textDocument/signatureHelp", at(uri, text, "f(3)], ", 7))
        label = shown["signatures"][0]["label"]
        self.assertEqual(label, "module wheel(r, width = 2)")
        self.assertEqual([label[slice(*p["label"])] for p in shown["signatures"][0]["parameters"]], ["r", "width = 2"])
        self.assertEqual(shown["activeParameter"], 2)
        shown = client.ask("textDocument/signatureHelp", at(uri, text, "width = 3", 8))
        self.assertEqual(shown["activeParameter"], 1)
        self.assertIsNone(client.ask("textDocument/signatureHelp", at(uri, text, "count = 4")))

    def test_parameters_whose_defaults_are_texts(self):
        """Commas and brackets in them separate nothing; places count as the editor counts."""
        text = 'module m(a = ",)", b = "\u00e9\u00e9", c = [1, "("]) cube(1);\nm(1'
        for encodings in (["utf-16"], ["utf-8"]):
            client = self.start(encodings=encodings)
            uri = client.open(self.path("a.txt"), text)
            shown = client.ask("textDocument/signatureHelp", at(uri, text, "m(1", 3))["signatures"][0]
            label = shown["label"].encode("utf-8" if encodings == ["utf-8"] else "utf-16-le")
            size = 1 if encodings == ["utf-8"] else 2
            parts = [label[size * p["label"][0]:size * p["label"][1]].decode("utf-8" if size == 1 else "utf-16-le") for p in shown["parameters"]]
            self.assertEqual(parts, ['a = ",)"', 'b = "\u00e9\u00e9"', 'c = [1, "("]'])

    def test_long_defaults_are_cut_between_characters(self):
        client = self.start()
        for ahead in range(4):
            text = f'x = "{ahead * "a"}{30 * chr(0xe9)}{30 * chr(0x1F600)}";\ny = x;\n'
            uri = client.open(self.path("a.txt"), text)
            value = client.ask("textDocument/hover", at(uri, text, "x;"))["contents"]["value"]
            self.assertIn(chr(0xe9) + "...\n", value)
            self.assertNotIn("\ufffd", value)

    def test_symbols_and_folds(self):
        client, uri = self.open_main()
        symbols = client.ask("textDocument/documentSymbol", {"textDocument": {"uri": uri}})
        self.assertEqual([(s["name"], [c["name"] for c in s["children"]]) for s in symbols],
                         [("count", []), ("cart", ["i"]), ("twice", [])])
        folds = client.ask("textDocument/foldingRange", {"textDocument": {"uri": uri}})
        self.assertEqual([(f["startLine"], f["endLine"]) for f in folds], [(5, 8)])

    def test_texts_that_are_being_written(self):
        client = self.start()
        uri = client.open(self.path("a.txt"), "")
        for text in ("translate([1, 2\nmodule after() cube(1);\nafter", "if (a { b(", "x = [for (i = [1 : 3]) i", "}", "include <", "f(g(h("):
            client.change(uri, text)
            for method in ("hover", "definition", "references", "completion", "signatureHelp"):
                for offset in range(len(text)):
                    client.ask(f"textDocument/{method}", {"textDocument": {"uri": uri}, "position": place(text, text[offset:])})
        client.change(uri, text := "translate([1, 2\nmodule after() cube(1);\nafter();\n")
        self.assertEqual(client.ask("textDocument/definition", at(uri, text, "after();"))[0]["range"]["start"]["line"], 1)


class Text(Lsp):
    def test_formatting(self):
        client = self.start()
        text = "// one\nx=1;\ny = 2;\n"
        uri = client.open(self.path("a.txt"), text)
        edits = client.ask("textDocument/formatting", {"textDocument": {"uri": uri}, "options": {}})
        self.assertEqual(edits, [{"range": {"start": {"line": 1, "character": 0}, "end": {"line": 2, "character": 0}}, "newText": "x = 1;\n"}])
        client.change(uri, "x = 1;\n")
        self.assertEqual(client.ask("textDocument/formatting", {"textDocument": {"uri": uri}, "options": {}}), [])
        client.change(uri, "x = (1;\n")
        self.assertIn("expected ')'", client.call("textDocument/formatting", {"textDocument": {"uri": uri}, "options": {}})["error"]["message"])

    def test_colors_and_lens(self):
        client, uri = self.open_main()
        colors = client.ask("textDocument/documentColor", {"textDocument": {"uri": uri}})
        self.assertEqual(colors, [{"range": {"start": place(MAIN, '"red"'), "end": place(MAIN, '"red"', 5)},
                                   "color": {"red": 1, "green": 0, "blue": 0, "alpha": 1}}])
        shown = client.ask("textDocument/colorPresentation", {"textDocument": {"uri": uri}, "color": {"red": 0, "green": 0.5, "blue": 1, "alpha": 0.5}})
        self.assertEqual(shown, [{"label": '"#0080ff80"'}])
        lens = client.ask("textDocument/codeLens", {"textDocument": {"uri": uri}})
        self.assertEqual((lens[0]["command"]["command"], lens[0]["command"]["arguments"]), ("csgmesh.view", [uri]))


class Nonsense(Lsp):
    def code(self, client):
        return client.receive()["error"]["code"]

    def test_errors_of_the_protocol(self):
        client = self.start(initialize=False)
        self.assertEqual(client.call("textDocument/hover", {})["error"]["code"], -32002)
        client.ask("initialize", {})
        self.assertEqual(client.call("initialize", {})["error"]["code"], -32600)
        self.assertEqual(client.call("textDocument/nonsense", {})["error"]["code"], -32601)
        client.tell("textDocument/nonsense", {})
        client.send({"id": "text", "method": "shutdown"})
        self.assertEqual(client.receive(), {"jsonrpc": "2.0", "id": "text", "result": None})
        self.assertEqual(client.call("textDocument/hover", {})["error"]["code"], -32600)
        client.tell("exit", None)
        self.assertEqual(client.end()[0], 0)

    def test_broken_frames(self):
        client = self.start()
        for data, code in ((b"Content-Length: 5\r\n\r\n{\"a\":", -32700), (b"Content-Length: x\r\n\r\n", -32700), (b"Hello\r\n\r\n", -32700),
                           (b"Content-Length: -1\r\n\r\n", -32700), (b"Content-Length: 2\r\n\r\n[]", -32600), (b"Content-Length: 4\r\n\r\nnull", -32600),
                           (b"Content-Length: 0\r\n\r\n", -32700), (b"x" * 9000 + b"\r\n\r\n", -32700),
                           (b"Content-Length: 200\r\n\r\n" + b"[" * 200, -32700)):
            client.send_bytes(data)
            self.assertEqual(self.code(client), code, data[:40])
        size = 70 << 20
        client.send_bytes(b"Content-Length: %d\r\n\r\n" % size)
        self.assertEqual(self.code(client), -32700)
        for _ in range(70):
            client.send_bytes(b" " * (1 << 20))
        self.assertIsNone(client.ask("textDocument/hover", {"textDocument": {"uri": "file:///none.txt"}, "position": {}}))
        self.assertEqual(client.stop()[0], 0)

    def test_the_end_of_the_input(self):
        self.assertEqual(self.start().end(), (1, ""))
        for data in (b"Content-Length: 100\r\n\r\n{", b"Content-Len", b"Content-Length: 70000000\r\n\r\n{", b"x" * 9000):
            client = self.start()
            client.send_bytes(data)
            self.assertEqual(client.end(), (1, "csgmesh: error: the input ends within a message\n"), data[:40])
        self.assertIn("lsp takes no scene", cli.run("lsp", "a.txt").stderr)

    def test_a_file_that_vanishes(self):
        client, uri = self.open_main()
        client.ask("textDocument/definition", at(uri, MAIN, "wheel(r"))
        os.remove(self.path("wheel.txt"))
        os.remove(self.path("main.txt"))
        self.assertEqual(client.ask("textDocument/definition", at(uri, MAIN, "wheel(r")), [])
        client.change(uri, MAIN + "\n")
        self.assertIn("E0122", [f["code"] for f in client.wait_for_findings(uri)])
        self.assertEqual(client.stop()[0], 0)

    def test_random_messages(self):
        chance = random.Random(1)
        client, uri = self.open_main()
        values = [None, True, -1, 1e300, "", "x", uri, [], {}, {"uri": uri}, {"line": 4, "character": 9}, {"line": -5, "character": 1 << 40}]
        keys = ["textDocument", "position", "context", "newName", "color", "contentChanges", "range", "options"]
        methods = ["hover", "definition", "references", "rename", "completion", "signatureHelp", "documentSymbol", "formatting",
                   "colorPresentation", "foldingRange", "codeLens", "prepareRename", "documentHighlight", "documentColor"]
        for _ in range(400):
            params = {key: chance.choice(values) for key in chance.sample(keys, 4)}
            self.assertIn("id", client.call("textDocument/" + chance.choice(methods), chance.choice([params, params, None, [1]])))
            client.tell("textDocument/did" + chance.choice(["Change", "Save", "Open"]), {**params, "textDocument": {"uri": chance.choice(values)}})
        for _ in range(100):
            body = bytearray(json.dumps({"id": 1, "method": "textDocument/hover", "params": at(uri, MAIN, "cube(")}).encode())
            for _ in range(3):
                body[chance.randrange(len(body))] = chance.randrange(256)
            client.send_bytes(b"Content-Length: %d\r\n\r\n" % len(body) + bytes(body))
        self.assertEqual(client.stop()[0], 0)

    @unittest.mock.patch.dict(os.environ, ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0")
    def test_roots(self):
        """Without a search for leaks: its look at /proc is refused, too."""
        os.mkdir(self.path("in"))
        client = self.start("--root", self.path("in"))
        uri = client.open(self.path("in/a.txt"), text := "use <../wheel.txt>\nwheel(1);\n")
        self.assertTrue({"E0121", "E0122"} & {f["code"] for f in client.wait_for_findings(uri)})
        self.assertEqual(client.ask("textDocument/definition", at(uri, text, "wheel(1")), [])
        self.assertEqual(client.stop()[0], 0)


if __name__ == "__main__":
    unittest.main()
