a = 2; b = 8; c = 3;
echo([a : c : b], [for (i = [a : c : b]) i], [for (i = [a + 1 : b - 1]) i], [a : b][2]);
