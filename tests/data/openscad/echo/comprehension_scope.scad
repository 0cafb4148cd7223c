i = "outer";
echo([for (i = [0 : 1]) i], i);
f = function(i) [for (j = [0 : i]) i * j];
echo(f(2), i);
x = [for (i = [0 : 2]) let (i = i + 1, j = i) [i, j]];
echo(x);
