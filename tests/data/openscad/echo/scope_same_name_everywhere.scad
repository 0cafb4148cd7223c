a = 1;
function a() = 2;
module a() echo("module a", a, a());
a();
echo(a, a());
