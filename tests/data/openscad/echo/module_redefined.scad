module m() echo("first");
m();
module m() echo("second");
m();
function f() = 1;
echo(f());
function f() = 2;
echo(f());
