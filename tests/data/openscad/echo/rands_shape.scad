echo(len(rands(0, 1, 5)), len(rands(0, 1, 0)), len(rands(3, 7, 3, 42)));
v = rands(3, 7, 100, 42);
echo(min(v) >= 3, max(v) < 7, rands(1, 1, 3), rands(0, 1, 2, 5) == rands(0, 1, 2, 5));
w = rands(7, 3, 50, 1);
echo(min(w) >= 3, max(w) <= 7);
