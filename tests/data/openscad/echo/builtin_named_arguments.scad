echo(max(a = 1, b = 3), sin(x = 30), len(v = [1]), str(a = 1, b = 2), pow(base = 2, exponent = 3), concat(a = [1], b = [2]));
echo(lookup(table = 1, k = [[1, 5]]), round(x = 2.5), norm(v = [3, 4]), rands(min = 0, max = 1, n = 1, seed = 42));
