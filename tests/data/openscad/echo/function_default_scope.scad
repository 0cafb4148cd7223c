a = 1;
function f(x = a) = let (a = 50) x;
module m(x = a) { a = 60; echo(x, a); }
echo(f());
m();
function g(x, y = x + 1) = [x, y];
echo(g(1));
