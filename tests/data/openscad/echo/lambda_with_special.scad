$k = 1;
f = function(x) x + $k;
echo(f(1));
echo(let ($k = 10) f(1));
module m() { $k = 100; echo(f(1)); }
m();
