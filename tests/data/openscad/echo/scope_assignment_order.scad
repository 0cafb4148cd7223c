a = b;
b = 2;
echo(a, b);
c = 1;
d = c;
c = 3;
echo(c, d);
