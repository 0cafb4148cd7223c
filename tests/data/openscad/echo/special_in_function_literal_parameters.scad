f = function($a = 1, b = 2) g();
function g() = $a;
echo(f(), f(5), f($a = 6));
