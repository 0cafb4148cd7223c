echo("a");// comment
x = 1;
echo(x);
