// Faces with many corners, one of them concave.
outline = [[0, 0], [24, 0], [24, 10], [10, 10], [10, 20], [0, 20]];
polyhedron(points = concat([for (p = outline) [p.x, p.y, 0]], [for (p = outline) [p.x, p.y, 9]]),
           faces = concat([[for (i = [0 : 5]) i], [for (i = [11 : -1 : 6]) i]],
                          [for (i = [0 : 5]) [i, i + 6, (i + 1) % 6 + 6, (i + 1) % 6]]));
