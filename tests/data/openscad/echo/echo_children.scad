echo("outer") echo("inner");
echo("a") { echo("b"); cube(); echo("c"); }
module m() { echo(parent_module(0)) children(); }
m() echo("x");
