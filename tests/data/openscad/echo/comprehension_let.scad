echo([for (i = [1 : 3]) let (a = i * i, b = a + 1) [a, b]], [let (x = 5) x], [let (x = 1) for (i = [x : 3]) i]);
echo([for (i = [0 : 2]) let (j = i + 1) if (j != 2) j], [for (a = [1 : 3]) let (a = a * 2) a]);
