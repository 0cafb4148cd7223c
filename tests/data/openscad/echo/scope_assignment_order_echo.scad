a = echo("a first") 1;
b = echo("b") 2;
a = echo("a second") 3;
echo(a, b);
