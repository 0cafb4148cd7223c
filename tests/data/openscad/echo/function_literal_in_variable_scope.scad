f = function(x) x + 1;
module m(f) { echo(f(1)); }
m(function(x) x * 100);
m(f);
function apply(f, x) = f(x);
echo(apply(f, 2), apply(function(x) str(x), 2));
let (f = function(x) "let") echo(f(0));
