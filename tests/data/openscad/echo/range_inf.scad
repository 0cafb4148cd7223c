echo([for (i = [5 : 0 / 0]) i]);
echo([for (i = [0 : 0 / 0 : 5]) i]);
echo([for (i = [0 : 1 / 0 : 5]) i], [for (i = [0 : -1 / 0 : 5]) i]);
