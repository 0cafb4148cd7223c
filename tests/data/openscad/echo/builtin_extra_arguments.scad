echo(sin(30, 40));
echo(abs(-1, 2));
echo(is_undef(1, 2));
echo(ord("a", 1), len("a", "b"), floor(1.5, 2), sqrt(4, 9));
