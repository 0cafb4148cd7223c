for (x = [[], [[]], "", [""], [undef]]) { for (y = x) echo("y", y); echo("x", x); }
for (i = [0 : 0.5 : 1.5]) echo(i);
for (i = [1 : -0.25 : 0]) echo(i);
