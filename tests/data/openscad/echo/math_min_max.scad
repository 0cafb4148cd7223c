echo(min(1, 2, 3), max(1, 2, 3), min([3, 1, 2]), max([3, 1, 2]), min(5), max(-5), min([7]));
echo(min([]), max([]));
echo(min(), max());
echo(min("a", "b"));
echo(min(1, "a"), max([1, "a"]), min(1, undef), max([1, 2], [3, 4]));
echo(min([1, 2], 3));
echo(max(1, 0 / 0), max(0 / 0, 1), min(0 / 0, 1), min(1, 0 / 0));
