vals = [1, true, "a", [1], undef, [0 : 1]];
for (a = vals, b = vals) echo(a, b, a == b, a != b, a < b, a > b, a <= b, a >= b);
