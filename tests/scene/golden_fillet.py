#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints the rows "fillet" of golden.csv: pairs and triples of planes, with 40 digits (mpmath).

Not by the closed forms of scene/operators/fillet.h, but by what defines the level of a subset
(operators.md 16): the shortest s with n_i . s = r + f_i - G for its operands, n_i = -g_i, has
|s| = r. G is found by bisection; a subset counts where s is a sum of its n_i with weights >= 0. The
shares are these weights over their sum.

Columns: fillet, r, values, gradients, F, shares in the order of the operands.
"""
import itertools
import random

from mpmath import mp, mpf, matrix, lu_solve, sqrt

mp.dps = 40


def unit(v):
    length = sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def radius_of(r, gradients):
    """It fades where two faces look at each other."""
    least = mpf(1)
    for a, b in itertools.combinations(gradients, 2):
        t = min(max((-dot(a, b) - mpf(7) / 10) / (mpf(1) / 4), 0), 1)
        least = min(least, 1 - t * t * (3 - 2 * t))
    return r * least


def weights_at(level, r, values, gram):
    return lu_solve(gram, matrix([r + f - level for f in values]))


def square_at(level, r, values, gram):
    w = weights_at(level, r, values, gram)
    return sum(w[i] * (r + f - level) for i, f in enumerate(values))


def level_of(r, values, gradients):
    """G and the weights of one subset, or None where it does not count."""
    r = radius_of(r, gradients)
    count = len(values)
    gram = matrix(count, count)
    for i in range(count):
        for k in range(count):
            gram[i, k] = dot(gradients[i], gradients[k])
    if r <= 0 or mp.det(gram) < mpf(10) ** -9:
        return None
    # |s|^2 falls with G down to where it is least, then rises: the smaller root is to the left
    low, high = min(values) - 4 * r, max(values) + 4 * r
    for _ in range(200):  # where it is least
        a, b = low + (high - low) / 3, high - (high - low) / 3
        if square_at(a, r, values, gram) < square_at(b, r, values, gram):
            high = b
        else:
            low = a
    bottom = (low + high) / 2
    if square_at(bottom, r, values, gram) > r * r:
        return None
    low, high = bottom - 1000 * r, bottom
    for _ in range(200):
        middle = (low + high) / 2
        if square_at(middle, r, values, gram) > r * r:
            low = middle
        else:
            high = middle
    level = (low + high) / 2
    weights = weights_at(level, r, values, gram)
    return (level, list(weights)) if all(w >= 0 for w in weights) else None


def fillet(r, values, gradients):
    top = max(range(len(values)), key=lambda i: values[i])
    best, shares = values[top], [mpf(i == top) for i in range(len(values))]
    for count in (2, 3):
        for subset in itertools.combinations(range(len(values)), count):
            found = level_of(r, [values[i] for i in subset], [gradients[i] for i in subset])
            if found and found[0] > best:
                best, shares = found[0], [mpf(0)] * len(values)
                for i, w in zip(subset, found[1]):
                    shares[i] = w / sum(found[1])
    return best, shares


def row(r, values, gradients):
    level, shares = fillet(mpf(r), [mpf(v) for v in values], [unit([mpf(x) for x in g]) for g in gradients])
    text = lambda numbers: ";".join(mp.nstr(x, 17) for x in numbers)
    plain = lambda numbers: ";".join(str(x) for x in numbers)
    print(f"fillet,{r},{plain(values)},{plain(x for g in gradients for x in g)},{text([level])},{text(shares)}")


def main():
    row(0.5, [0.1, 0.1], [[1, 0, 0], [0, 1, 0]])
    row(0.5, [0.1, -0.2], [[1, 0, 0], [0, 1, 0]])
    row(0.5, [0.1, -0.4], [[1, 0, 0], [0, 1, 0]])
    row(0.5, [0, 0], [[0, 0, 1], [0, 0, 1]])
    row(0.5, [0, 0], [[0, 0, 1], [0, 0, -1]])
    row(0.5, [-0.3, -0.25], [[0, 0, 1], [0, 0.8, -0.6]])
    row(1, [-0.3, -0.25], [[0, 0, 1], [0, 0.6, -0.8]])
    row(1, [0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    row(2, [-0.7, -0.75, -0.8], [[1, 0, 0], [0.1, 1, 0], [0.2, -0.3, 1]])
    row(1, [-0.5, -0.5, -0.5], [[1, 0, 0], [-0.5, 0.75, 0], [-0.5, -0.75, 0.25]])
    chance = random.Random(16)
    for count in [2] * 10 + [3] * 22:
        values = [round(chance.uniform(-0.6, 0), 3) for _ in range(count)]
        gradients = [[round(chance.gauss(0, 1), 3) for _ in range(3)] for _ in range(count)]
        row(round(chance.uniform(0.3, 1), 3), values, gradients)


if __name__ == "__main__":
    main()
