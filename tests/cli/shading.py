# SPDX-License-Identifier: MIT
"""How viewers would shade a mesh."""
import math


def tilt_of_large_faces(path, least):
    """(how many triangles of an OBJ file have an area of `least` or more, the largest angle in degrees of a normal at their corners to them)."""
    with open(path, encoding="utf-8") as file:
        lines = [line.split() for line in file]
    at, normals = ([[float(x) for x in words[1:4]] for words in lines if words[:1] == [kind]] for kind in ("v", "vn"))
    count, most = 0, 0.0
    for words in lines:
        if words[:1] != ["f"]:
            continue
        corners = [[int(x or 0) - 1 for x in word.split("/")] for word in words[1:]]
        a, b, c = (at[corner[0]] for corner in corners)
        u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        cross = [u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2] for k in range(3)]
        twice = math.hypot(*cross)
        if twice < 2 * least:
            continue
        count += 1
        for corner in corners:
            cosine = sum(cross[k] * normals[corner[-1]][k] for k in range(3)) / twice
            most = max(most, math.degrees(math.acos(min(cosine, 1))))
    return count, most
