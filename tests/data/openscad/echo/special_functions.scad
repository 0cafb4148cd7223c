function f() = $x;
$x = 1;
echo(f(), f($x = 2));
module m() { $x = 3; echo(f()); }
m();
echo(let ($x = 4) f(), f());
echo([for ($x = [5 : 6]) f()]);
