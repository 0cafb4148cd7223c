module m() { echo($children); children(); }
m() if (true) echo("then");
m() if (false) echo("then"); else echo("else");
m() for (i = [0 : 1]) echo(i);
