f = function(x) "variable";
function f(x) = "function";
echo(f(1));
module m() { f = function(x) "inner variable"; echo(f(1)); }
m();
function g(f) = f(1);
echo(g(function(x) "parameter"));
