function f(a, b, ) = [a, b];
echo(f(1, 2), [1, 2, ], [[1, ], ]);
module m(a, b = 2, ) echo(a, b);
m(1);
echo(len([for (i = [0 : 2]) i, ]));
