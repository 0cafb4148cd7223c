x = 3;
echo("begin");
assert(x > 1 && len("abc") == 3 || [1, 2][0] == 1);
assert(x == 4, ["list", 1]);
