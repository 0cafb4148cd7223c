echo(ord("a"), ord("abc"), ord("é"), ord("€"), ord("😀"), ord("\n"));
echo(ord(""));
echo(ord(1));
echo(ord(undef));
echo(ord(["a"]));
echo(ord());
echo(ord("a", "b"));
