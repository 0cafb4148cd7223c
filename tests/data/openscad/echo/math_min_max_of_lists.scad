echo(max(["a", 1]), max(["a", "b"]), max([[1], [2]]), min([true, false]), min([1, "a", 0]), max([undef, 1]), min([[3, 1], [2, 5]]));
echo(max("a"), max(true), min(undef), min(1, [2]), min([1], 2), max([[1, 2]]));
echo(min([3]), max([[]]), min(-0, 0), max([1, 2, 3], 1));
