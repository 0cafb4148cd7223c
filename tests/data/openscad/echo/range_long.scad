s = [for (i = [0 : 0.01 : 0.1]) i];
echo(len(s), s);
echo(len([for (i = [0 : 0.1 : 1]) i]), len([for (i = [1 : 0.1 : 2]) i]), len([for (i = [0 : 1 / 7 : 1]) i]), len([for (i = [0 : 9999]) i]));
echo([for (i = [-1 : 0.3 : 1]) i], [for (i = [10 : -3 : -10]) i]);
