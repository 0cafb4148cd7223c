#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A picture of a trace for a page: timeline.py TRACE.json -o FILE.svg [--title TEXT]

Time runs to the right. Each thread is a band: the stages that it is in, nested downwards, below them its parts of
parallel loops. Perfetto shows the same file to zoom into; this is for what does not move.
"""
import argparse
import json
import sys
from html import escape

WIDTH, LEFT, ROW, GAP = 1200, 110, 17, 14
COLORS = ["#4e79a7", "#f28e2b", "#59a14f", "#e15759", "#76b7b2", "#edc948", "#b07aa1", "#ff9da7", "#9c755f", "#86bcb6"]


def depths(zones):
    """(depth, zone) of one thread."""
    stack = []
    for zone in sorted(zones, key=lambda z: (z["ts"], -z["dur"])):
        while stack and stack[-1] <= zone["ts"] + 0.002:
            stack.pop()
        yield len(stack), zone
        stack.append(zone["ts"] + zone["dur"])


def box(x, y, width, zone, color):
    is_loop = zone["cat"] == "loop"
    counts = ", ".join(f"{key} {value}" for key, value in zone.get("args", {}).items() if key != "caller")
    out = [f'<g><title>{escape(zone["name"])}: {zone["dur"] / 1000:.3f} ms{escape(", " + counts if counts else "")}</title>'
           f'<rect x="{x:.2f}" y="{y}" width="{max(width, 0.4):.2f}" height="{ROW - 2}" fill="{color}" '
           f'fill-opacity="{0.55 if is_loop else 1}"/>']
    if width > 7 * len(zone["name"]) + 6:
        out.append(f'<text x="{x + 4:.2f}" y="{y + ROW - 6}" fill="{"black" if is_loop else "white"}">'
                   f'{escape(zone["name"])}</text>')
    return "".join(out) + "</g>"


def picture(trace, title):
    events = trace["traceEvents"]
    zones = [e for e in events if e["ph"] == "X"]
    names = {e["tid"]: e["args"]["name"] for e in events if e["name"] == "thread_name"}
    begin = min(z["ts"] for z in zones)
    length = max(z["ts"] + z["dur"] for z in zones) - begin
    scale = (WIDTH - LEFT - 10) / length
    colors = {}
    for zone in sorted(zones, key=lambda z: z["ts"]):
        colors.setdefault(zone["name"], COLORS[len(colors) % len(COLORS)])
    body, y = [], 40
    for thread in sorted(names):
        rows = list(depths([z for z in zones if z["tid"] == thread]))
        body.append(f'<text x="6" y="{y + ROW - 6}" fill="black">{escape(names[thread])}</text>')
        for depth, zone in rows:
            body.append(box(LEFT + (zone["ts"] - begin) * scale, y + depth * ROW, zone["dur"] * scale, zone,
                            colors[zone["name"]]))
        y += (max(depth for depth, _ in rows) + 1) * ROW + GAP
    body.append(f'<text x="{LEFT}" y="18" fill="black">{escape(title)} ({length / 1000:.1f} ms)</text>')
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{y}" viewBox="0 0 {WIDTH} {y}" '
            f'font-family="sans-serif" font-size="11"><rect width="{WIDTH}" height="{y}" fill="white"/>\n'
            + "\n".join(body) + "\n</svg>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("trace")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--title", default="csgmesh")
    options = parser.parse_args()
    with open(options.trace, encoding="utf-8") as file:
        text = picture(json.load(file), options.title)
    with open(options.output, "w", encoding="utf-8") as file:
        file.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
