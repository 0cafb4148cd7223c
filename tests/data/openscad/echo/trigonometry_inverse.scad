for (x = [-1 : 0.25 : 1]) echo(asin(x), acos(x), atan(x));
echo(asin(0.5) == 30, acos(0.5) == 60, atan(1) == 45, asin(2), acos(-2), atan(1 / 0), atan(-1 / 0));
echo(asin(sqrt(3) / 2), acos(sqrt(2) / 2), atan(sqrt(3)), atan(1 / sqrt(3)));
