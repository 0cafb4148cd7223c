module m(a, b) echo(a, b);
m(a = 1, a = 2);
m(1, 2, a = 3);
function f(a, b) = [a, b];
echo(f(a = 1, a = 2), f(1, a = 5), f(a = 5, 1));
