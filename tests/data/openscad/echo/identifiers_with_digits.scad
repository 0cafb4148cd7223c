1x = 3;
2d = 4;
echo(1x, 2d);
function 3f(x) = x * 2;
module 4m(5a) echo(5a);
echo(3f(4));
4m(7);
4m(5a = 8);
