r = [0 : 3];
echo(r ? "range is true" : "false", [1 : 0 : 1] ? 1 : 2, r == r, r != [0 : 3]);
