echo(rands(0, 1, 5, 42));
echo(rands(0, 1, 3, 42));
echo(rands(-10, 10, 4, 1), rands(0, 100, 3, 0), rands(5, 6, 2, 123456));
echo(rands(0, 1, 2, -1), rands(0, 1, 2, 1.7), rands(10, 0, 3, 7));
echo(rands(0, 1, 2, 4294967296), rands(0, 1, 2, 1e20));
