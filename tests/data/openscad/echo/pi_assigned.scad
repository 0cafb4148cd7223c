PI = 3;
echo(PI);
