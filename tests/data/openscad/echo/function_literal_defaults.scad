f = function(a, b = 10, c) [a, b, c];
echo(f(1), f(1, 2), f(c = 3), f(1, 2, 3), f(b = 0, a = 1));
