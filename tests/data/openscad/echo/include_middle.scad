echo("before");
include <lib/statements.scad>
echo("after", from_statements);
module m() { include <lib/inner.scad> }
m();
