for (i = [0 : 2]) echo(i);
for (i = [0, 5, "a", true, [1, 2], undef]) echo(i);
for (i = "héy") echo(i);
for (i = 5) echo(i);
for (i = undef) echo("never");
for (i = []) echo("never");
for (v = [[1, 2], [3, 4]]) echo(v, v[0], v.y);
for (i = true) echo(i);
