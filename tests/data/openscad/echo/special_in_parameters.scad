module m($a = 1) { n(); }
module n() echo($a);
m();
m(2);
m($a = 3);
function f($b = 5) = g();
function g() = $b;
echo(f(), f(6), f($b = 7));
