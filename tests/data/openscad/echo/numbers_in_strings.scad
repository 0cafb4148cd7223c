echo(str(0.1), str(1e-7), str(1e7), str(123456789), str(-0.5), str(100), str(1 / 3));
echo(str(1.0), str(1.10), str(10 / 4), str(2 ^ 0.5), str([1.50, 2.0]));
