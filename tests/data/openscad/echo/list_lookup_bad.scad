echo(lookup("a", [[1, 2]]));
echo(lookup(1, []));
echo(lookup(1, "abc"));
echo(lookup(1, [[1]]));
echo(lookup(1, [["a", 2], [2, 3]]));
echo(lookup(5, [[1, 2], ["a", 7], [10, 20]]), lookup(1), lookup(), lookup(undef, [[1, 2]]), lookup(1, [[1, "a"]]));
echo(lookup(0 / 0, [[1, 2], [3, 4]]), lookup(1 / 0, [[1, 2], [3, 4]]), lookup(1.5, [[1, 10, 3], [2, 20, 4]]));
