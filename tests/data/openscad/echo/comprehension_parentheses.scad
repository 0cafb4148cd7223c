echo([for (i = [0 : 2]) (i)], [(1), (2)], [for (i = [0 : 2]) (i > 0 ? i : -1)]);
echo([for (i = [0 : 1]) (for (j = [0 : 1]) [i, j])]);
echo([for (i = [0 : 3]) (if (i > 1) i)]);
