for (x = [-2.5, -1.5, -0.5, 0.5, 1.5, 2.5, 2.4, 2.6, -2.4, -2.6, 0.49999999999999994]) echo(x, round(x), floor(x), ceil(x));
echo(round(1e20), floor(-1e-10), ceil(1e-10), round("a"), floor(undef), ceil([1]));
