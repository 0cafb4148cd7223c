for (a = [-100 : 17 : 100]) echo(sin(a), cos(a), tan(a));
echo(sin(1e6), cos(1e6), tan(1e6), sin(1e-6), cos(1e-6), sin(1e15));
echo(sin(1 / 0), cos(-1 / 0), tan(1 / 0), sin(0 / 0));
echo(sin("a"), cos(undef), tan([1]), sin(), cos(1, 2));
