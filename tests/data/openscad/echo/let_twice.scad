let (a = 1, a = 2) echo(a);
echo([let (a = 1, a = 2) a], let (a = 1, b = 2, a = 3) [a, b]);
echo([for (i = 0, i = 5; i < 7; i = i + 1) i]);
echo([for (i = 0; i < 3; i = i + 1, i = i + 5) i]);
echo([for (i = [0 : 1], i = [5 : 6]) i]);
for (i = [0 : 1], i = [5 : 6]) echo(i);
assign (a = 1, a = 3) echo(a);
