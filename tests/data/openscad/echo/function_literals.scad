add = function(a, b) a + b;
twice = function(f, x) f(f(x));
echo(add(1, 2), twice(function(x) x * 3, 2), (function(x) x ^ 2)(5), is_function(add));
compose = function(f, g) function(x) f(g(x));
inc = function(x) x + 1;
dbl = function(x) x * 2;
echo(compose(inc, dbl)(5), compose(dbl, inc)(5));
fs = [inc, dbl, function(x) -x];
echo([for (f = fs) f(10)], fs[1](4));
