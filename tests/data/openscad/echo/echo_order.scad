function f(x) = echo(str("arg ", x)) x;
echo(f(1), f(2), f(3));
echo([f(1), f(2)], f(3) ? f(4) : f(5));
v = let (a = f(1), b = f(2)) [b, a];
echo(v, max(f(3), f(4)), f(f(5)));
