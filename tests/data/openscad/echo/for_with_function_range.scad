function corners(n) = [for (i = [0 : n - 1]) i * 360 / n];
for (a = corners(3)) echo(a, cos(a));
for (p = concat([[0, 0]], [[1, 1]])) echo(p.x, p.y);
