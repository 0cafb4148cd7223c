1e = 7;
2e3x = 8;
echo(1e, 2e3x, 1e3);
