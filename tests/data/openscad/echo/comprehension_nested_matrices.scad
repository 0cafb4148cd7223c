function identity(n) = [for (i = [0 : n - 1]) [for (j = [0 : n - 1]) i == j ? 1 : 0]];
function transpose(m) = [for (j = [0 : len(m[0]) - 1]) [for (i = [0 : len(m) - 1]) m[i][j]]];
echo(identity(3), transpose([[1, 2, 3], [4, 5, 6]]), identity(0), identity(1));
function flatten(l) = [for (a = l) for (b = a) b];
echo(flatten([[1, 2], [3], [], [4, 5]]));
function quicksort(v) = len(v) < 2 ? v : let (p = v[floor(len(v) / 2)])
    concat(quicksort([for (y = v) if (y < p) y]), [for (y = v) if (y == p) y], quicksort([for (y = v) if (y > p) y]));
echo(quicksort([3, 1, 4, 1, 5, 9, 2, 6]), quicksort(["pear", "apple", "fig"]));
