echo([for (i = [1 : 4]) i * i], [for (i = [3, 1, 2]) i], [for (c = "abc") c], [for (i = 5) i], [for (i = undef) i]);
echo([for (i = [0 : 1], j = [0 : 2]) [i, j]], [for (i = [0 : 2], j = [i : 2]) i + j]);
echo([for (i = [0 : 1]) for (j = [0 : 1]) i * 2 + j], [for (i = [0 : 1]) [for (j = [0 : 1]) j]]);
echo([for (i = []) i], [for (i = [[1, 2], [3]]) i], [for (i = true) i], [for (i = "") i]);
