echo([1 : 0 : 1]);
echo([for (i = [1 : 0 : 1]) i]);
