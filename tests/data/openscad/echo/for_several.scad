for (i = [0 : 1], j = [0 : 2]) echo(i, j);
for (i = [0 : 2], j = [i : 2]) echo(i, j);
for (a = "xy", b = [1, 2]) { c = str(a, b); echo(c); }
