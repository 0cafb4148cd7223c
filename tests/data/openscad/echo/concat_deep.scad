echo(concat([1, [2]], [[3]], 4, "five", [], undef, true, [[]]));
echo(concat(concat([1], [2]), concat()), len(concat([1, 2], "ab")), concat([[1, 2]], [[3, 4]]));
function rec(n) = n == 0 ? [] : concat(rec(n - 1), [n]);
echo(rec(10));
