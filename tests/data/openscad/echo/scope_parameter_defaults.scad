d = 5;
function f(a, b = a) = [a, b];
echo(f(1));
module m(a = d, b = a) echo(a, b);
m();
m(1);
module n() { d = 6; m(); }
n();
