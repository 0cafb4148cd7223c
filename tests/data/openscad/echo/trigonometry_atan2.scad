for (y = [-1 : 1], x = [-1 : 1]) echo(y, x, atan2(y, x));
echo(atan2(1, sqrt(3)), atan2(sqrt(3), 1), atan2(3, 4), atan2(0, -1), atan2(-0, -1), atan2(1 / 0, 1 / 0));
echo(atan2("a", 1), atan2(1), atan2());
