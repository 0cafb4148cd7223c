echo(len([]), len([1, 2]), len("abc"), len(""), len([[1, 2], [3]]), len("€"));
echo(len(5), len(undef), len(true), len([0 : 5]));
echo(len(), len([1], [2]));
