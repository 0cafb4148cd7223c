echo([each [0 : 2], each [5 : -2 : 0], each []]);
echo([for (r = [[0 : 1], [5 : 6]]) each r], [each [for (i = [0 : 1]) [i]]]);
echo([each [[0 : 2]]], [each "añb"]);
