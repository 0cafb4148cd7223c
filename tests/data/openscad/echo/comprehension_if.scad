echo([for (i = [0 : 9]) if (i % 2) i], [for (i = [0 : 4]) if (i > 2) "big" else i]);
echo([for (i = [0 : 9]) if (i > 3) if (i % 2 == 0) i], [if (true) 1], [if (false) 1], [if (false) 1 else 2]);
echo([for (i = [0 : 5]) if (i < 2) i else if (i < 4) i * 10 else i * 100]);
echo([for (i = [0 : 3]) if (i == 1) each [i, i] else i], [1, if (true) 2, 3, if (false) 4]);
