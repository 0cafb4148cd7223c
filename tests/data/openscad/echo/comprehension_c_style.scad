echo([for (i = 0; i < 5; i = i + 1) i], [for (i = 0, j = 10; i < j; i = i + 1, j = j - 2) [i, j]]);
echo([for (a = 0, b = 1; a < 50; t = a + b, a = b, b = t) a]);
echo([for (i = 0; i < 6; i = i + 1) if (i % 2) i], [for (i = 5; i > 0; i = i - 2) let (k = i * i) k]);
echo([for (i = 0; false; i = i + 1) i], [for (i = [1, 2, 3]; len(i) > 0; i = [for (k = [1 : 1 : len(i) - 1]) i[k]]) i[0]]);
sum = [for (v = [1, 2, 3], i = 0, s = 0; i <= len(v); s = s + (i < len(v) ? v[i] : 0), i = i + 1) s];
echo(sum);
