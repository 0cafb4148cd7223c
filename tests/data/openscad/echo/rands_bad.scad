echo(rands(0, 1, 0, 1), rands(0, 1, -1, 1), rands(0, 1, 2.9, 1));
echo(rands("a", 1, 2), rands(0, 1), rands(), rands(0, undef, 2), rands(0, 1, "a"), rands(0, 1, 2, "a"));
echo(rands(0, 1 / 0, 2, 1), rands(0 / 0, 1, 2, 1));
