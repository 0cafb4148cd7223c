x = 0;
for (i = [0 : 2]) { x = i * 10; echo(i, x); }
echo(x);
for (i = [0 : 1]) for (i = [5 : 6]) echo(i);
