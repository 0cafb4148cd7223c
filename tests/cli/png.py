# SPDX-License-Identifier: MIT
"""PNG pictures of 8 bits, not interlaced, as the tests read them: without a library."""
import struct
import zlib

CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}


def nearest(left, above, corner):
    """Paeth's: which of the three is nearest to left + above - corner."""
    a, b, c = abs(above - corner), abs(left - corner), abs(left + above - 2 * corner)
    return left if a <= b and a <= c else above if b <= c else corner


def unfiltered(how, line, before, channels):
    if how == 0:
        return line
    out = bytearray(line)
    for i, byte in enumerate(line):
        left, corner = (out[i - channels], before[i - channels]) if i >= channels else (0, 0)
        guess = {1: left, 2: before[i], 3: (left + before[i]) // 2, 4: 0}[how]
        out[i] = (byte + (nearest(left, before[i], corner) if how == 4 else guess)) & 255
    return bytes(out)


def read(data):
    """(width, height, channels, rows of bytes); sums of chunks must agree."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, {}
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        chunks[kind] = chunks.get(kind, b"") + body
        at += 12 + length
    width, height, depth, kind, *how = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    assert depth == 8 and how == [0, 0, 0]
    channels = CHANNELS[kind]
    raw, stride, rows, before = zlib.decompress(chunks[b"IDAT"]), width * channels + 1, [], bytes(width * channels)
    assert len(raw) == stride * height
    for y in range(height):
        before = unfiltered(raw[y * stride], raw[y * stride + 1:(y + 1) * stride], before, channels)
        rows.append(before)
    return width, height, channels, rows
