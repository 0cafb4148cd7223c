function f(n) = assert(is_num(n), "not a number") n;
echo(f(1));
echo(f("a"));
echo("after");
