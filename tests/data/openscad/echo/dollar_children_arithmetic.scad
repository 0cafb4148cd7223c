module spread(d) for (i = [0 : 1 : $children - 1]) { echo(i * d); children(i); }
spread(10) { echo("a"); echo("b"); echo("c"); }
spread(10);
