// A ring of four corners each: one hole through it.
n = 12;
section = [[10, -3], [16, -3], [16, 3], [10, 3]];
polyhedron(points = [for (i = [0 : n - 1], p = section) [p.x * cos(360 * i / n), p.x * sin(360 * i / n), p.y]],
           faces = [for (i = [0 : n - 1], k = [0 : 3])
                      let (j = (i + 1) % n, l = (k + 1) % 4) [4 * i + k, 4 * i + l, 4 * j + l, 4 * j + k]]);
