module m() { children(1); children(0); }
m() { echo("zero"); echo("one"); }
module all() children();
all() { echo("a"); echo("b"); }
module last() children($children - 1);
last() { echo(1); echo(2); echo(3); }
