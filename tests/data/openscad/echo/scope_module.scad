x = 1;
module m(y = x) { z = x + y; x = 7; echo(x, y, z); }
m();
m(5);
x = 2;
echo(x);
