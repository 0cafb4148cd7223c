#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the TrueType font of corpus/font: a box, a round letter and an accented one made of both.

Usage: tiny_font.py OUT
"""
import struct
import sys


def simple(points, on_curve):
    """A glyph of one contour."""
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    data = struct.pack(">hhhhh", 1, min(xs), min(ys), max(xs), max(ys))
    data += struct.pack(">HH", len(points) - 1, 0) + bytes(on_curve)
    for values in (xs, ys):
        before = 0
        for value in values:
            data += struct.pack(">h", value - before)
            before = value
    return data + b"\0" * (-len(data) % 4)


def composite(first, second):
    data = struct.pack(">hhhhh", -1, 0, 0, 500, 900)
    data += struct.pack(">HHhh", 0x0023, first, 0, 0) + struct.pack(">HHhh", 0x0003, second, 100, 600)
    return data + b"\0" * (-len(data) % 4)


def main():
    box = simple([(100, 0), (100, 700), (500, 700), (500, 0)], [1, 1, 1, 1])
    round_one = simple([(100, 200), (100, 400), (300, 400), (500, 400), (500, 200), (300, 0)], [1, 0, 1, 0, 1, 0])
    glyphs = [box, round_one, composite(0, 1)]
    places = [0]
    for glyph in glyphs:
        places.append(places[-1] + len(glyph))
    segments = [(65, 65, 1 - 65), (0x3b1, 0x3b1, 1 - 0x3b1), (0x645, 0x645, 2 - 0x645), (0xffff, 0xffff, 1)]
    n = len(segments)
    format_4 = struct.pack(">HHHH", 2 * n, 8, 2, 0)
    format_4 += b"".join(struct.pack(">H", s[1]) for s in segments) + b"\0\0"
    format_4 += b"".join(struct.pack(">H", s[0]) for s in segments)
    format_4 += b"".join(struct.pack(">H", s[2] & 0xffff) for s in segments) + b"\0\0" * n
    format_4 = struct.pack(">HHH", 4, 6 + len(format_4), 0) + format_4
    # one pair of kerning: A A closer by 50
    kern = struct.pack(">HH", 0, 1) + struct.pack(">HHH", 0, 20, 1) + struct.pack(">HHHHHHh", 1, 6, 0, 0, 1, 1, -50)
    tables = {
        b"cmap": struct.pack(">HHHHI", 0, 1, 3, 1, 12) + format_4,
        b"glyf": b"".join(glyphs),
        b"head": struct.pack(">IIIIHHQQhhhhHHhhh", 0x10000, 0x10000, 0, 0x5F0F3CF5, 0, 1000, 0, 0, 0, 0, 500, 900,
                             0, 8, 2, 1, 0),
        b"hhea": struct.pack(">IhhhHhhhhhhhhhhhH", 0x10000, 800, -200, 90, 600, 100, 100, 500, 1, 0, 0, 0, 0, 0, 0, 0,
                             3),
        b"hmtx": struct.pack(">HhHhHh", 600, 100, 600, 100, 600, 100),
        b"kern": kern,
        b"loca": b"".join(struct.pack(">I", p) for p in places),
        b"maxp": struct.pack(">IHHHHHHHHHHHHHH", 0x10000, 3, 6, 1, 12, 2, 1, 0, 0, 0, 0, 0, 0, 2, 1),
        b"post": struct.pack(">IIhhIIIII", 0x30000, 0, -100, 50, 0, 0, 0, 0, 0),
    }
    out = struct.pack(">IHHHH", 0x10000, len(tables), 128, 3, len(tables) * 16 - 128)
    offset = 12 + 16 * len(tables)
    body = b""
    for name, data in tables.items():
        out += name + struct.pack(">III", 0, offset + len(body), len(data))
        body += data + b"\0" * (-len(data) % 4)
    with open(sys.argv[1], "wb") as file:
        file.write(out + body)


if __name__ == "__main__":
    main()
