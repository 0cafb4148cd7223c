echo("a\qb");
echo(len("a\qb"), "\a\b\v");
echo("\x80", "\xff", "\x00", "\x0");
echo("\u12", "\U12345");
