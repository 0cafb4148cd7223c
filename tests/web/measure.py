#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""measure.py [COUNT]: the tables of docs/web.md, medians of COUNT (5), of the page and module in build-web.

Processor times hold on a busy machine, too; what the browser takes is by the clock. $CSGMESH is the native program, else
that in build. Needs what the test of the page needs.
"""
import functools
import http.server
import json
import os
import resource
import statistics
import subprocess
import sys
import threading

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
HERE = os.path.join(ROOT, "tests", "web")
PLACE = os.path.join(ROOT, "build-web")
PROGRAM = os.environ.get("CSGMESH", os.path.join(ROOT, "build", "tools", "csgmesh", "csgmesh"))
PARTS = sorted(f"scenes/parts/{name}" for name in os.listdir(os.path.join(ROOT, "scenes", "parts")) if name.endswith(".txt"))


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_): # pylint: disable=arguments-differ
        pass


def ask(script, *arguments):
    done = subprocess.run(["node", "--no-warnings", os.path.join(HERE, script), *arguments], check=True, capture_output=True, text=True,
                          env={**os.environ, "CSGMESH_VIEW": os.path.join(ROOT, "tools", "view")})
    return json.loads(done.stdout)


def native_ms(scene):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([PROGRAM, scene, "-o", "-", "-f", "ply", "--threads", "1"], cwd=ROOT, env={**os.environ, "CSGMESH_ISA": "sse2"}, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1000 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def main(count):
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=os.path.join(PLACE, "page"))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page = ask("measure.mjs", f"http://127.0.0.1:{server.server_port}/index.html", str(count), *PARTS)
        server.shutdown()
    module = {} # a process for each: Node 20 sometimes ends with a fault where one runs the module ten times anew, 24 does not
    for scene in PARTS:
        module.update(ask("worker_time.mjs", os.path.join(PLACE, "csgmesh.wasm"), ROOT, str(count), scene))
    median = statistics.median
    print("| part | key to coarse mesh | while one is made | key to full mesh | coarse, CPU | full, CPU | native, SSE2 | ratio |\n"
          "| --- | --: | --: | --: | --: | --: | --: | --: |")
    for scene in PARTS:
        seen, spent, native = page["scenes"][scene], module[scene], median(native_ms(scene) for _ in range(count))
        row = [median(seen["given"]), median(seen["interrupting"]), median(seen["full"]), median(spent["coarse"]), median(spent["full"]), native]
        print(f"| {os.path.basename(scene)[:-4]} | " + " | ".join(f"{value:.0f}" for value in row) + f" | {median(spent['full']) / native:.2f} |")
    drawn = [median(page["scenes"][scene]["drawn"]) for scene in PARTS]
    print(f"drawn by the processor: {min(drawn):.0f} to {max(drawn):.0f} ms after the key; warm visit: mesh {median(page['visits']['given']):.0f} ms, "
          f"drawn {median(page['visits']['drawn']):.0f} ms")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
