module m() { for (i = [0 : $children - 1]) { echo("child", i); children(i); } }
m() { v = 3; echo(v); echo(v * 2); }
m() { if (false) echo("never"); echo("second"); }
