x = 1;
if (x == 1) { x = x + 10; echo(x); } else { x = 20; echo(x); }
if (x != 1) echo("no"); else { y = x; echo("yes", y); }
if (false); else echo("else");
if (true) echo("then"); else;
if (true) { if (false) echo("a"); else echo("dangling"); }
if (true) if (false) echo("a"); else echo("inner else");
