module m(a) echo("m", a);
m(a = echo("argument") 5);
function f(x) = x;
echo(f(echo("inner") 1) + 1);
translate(echo("vector") [1, 2, 3]) echo("child");
