function f(a, b, c, d, e, g, h, i, j, k) = [a, b, c, d, e, g, h, i, j, k];
echo(f(1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
echo(f(k = 1, a = 2, 3, 4));
