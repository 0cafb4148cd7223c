x = 3;
function x(y) = y + x;
module x() echo("module x", x, x(1));
echo(x, x(10));
x();
