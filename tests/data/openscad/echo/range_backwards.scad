echo([5 : 1]);
echo([for (i = [5 : 1]) i]);
for (i = [3 : 0]) echo(i);
echo([for (i = [5 : 1 : 1]) i], [for (i = [1 : 0]) i]);
