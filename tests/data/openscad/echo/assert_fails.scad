echo("before");
assert(1 > 2);
echo("after");
