for (a = [0 : 15 : 90]) echo(a, sin(a) ^ 2 + cos(a) ^ 2, tan(a), sin(2 * a), asin(sin(a)), acos(cos(a)), atan(tan(a)));
echo(sin(30) + cos(60) == 1, sin(-30), cos(-60), tan(-45), tan(60), tan(30), sin(60), cos(30));
