a = echo("evaluating") 5;
echo(a);
function f(x) = echo("f", x = x) x * 2;
echo(f(3));
echo(echo("nothing"));
v = [echo("first") 1, echo("second") 2];
echo(v);
b = true ? echo("taken") 1 : echo("not") 2;
echo(echo("a") echo("b") "c");
