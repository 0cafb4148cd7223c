#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The report of `csgmesh diff --json` as a Markdown table: one row per file that is not the same."""
import json
import os
import sys

NONE = "\N{EM DASH}"


def number(value, form="{:.4g}"):
    return form.format(value) if isinstance(value, (int, float)) else NONE


def volume_change(pair):
    before, after = (pair.get(side, {}).get("volume") for side in ("a", "b"))
    if not isinstance(before, (int, float)) or not isinstance(after, (int, float)) or not before:
        return NONE
    return f"{100 * (after - before) / abs(before):+.2f} %"


def worst_place(pair):
    places = [place for way in ("a_to_b", "b_to_a") for place in pair.get(way, {}).get("worst", [])]
    if not places:
        return NONE
    at = max(places, key=lambda place: place["distance"])["at"]
    return ", ".join(number(x, "{:.3g}") for x in at)


def row(pair):
    name = os.path.basename(pair.get("file_b") or pair.get("file_a") or "?").replace("|", "\\|")
    low, high = pair.get("hausdorff") or (None, None)
    triangles = [str(pair.get(side, {}).get("triangles", NONE)) for side in ("a", "b")]
    verdict = pair["verdict"]
    if pair.get("reasons"):
        verdict += ": " + ", ".join(pair["reasons"])
    distance = number(high) if low == high else f"{number(low)} to {number(high)}"
    return f"| {name} | {verdict} | {distance} | {worst_place(pair)} | " \
           f"{volume_change(pair)} | {' to '.join(triangles)} |"


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        report = json.load(file)
    pairs = report.get("pairs", [report])
    print("| mesh | verdict | largest distance | at | volume | triangles |")
    print("| --- | --- | --- | --- | --- | --- |")
    for pair in pairs:
        if pair["verdict"] != "same":
            print(row(pair))


if __name__ == "__main__":
    main()
