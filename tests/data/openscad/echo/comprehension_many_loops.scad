echo([for (i = [0 : 2]) for (j = [0 : i]) for (k = [0 : j]) i * 100 + j * 10 + k]);
echo([for (i = [1 : 3]) if (i != 2) for (j = [1 : i]) let (p = i * j) if (p > 1) p]);
echo([for (i = 0; i < 2; i = i + 1) for (j = 0; j < 2; j = j + 1) [i, j]]);
