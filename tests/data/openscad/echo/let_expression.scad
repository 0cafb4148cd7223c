echo(let (a = 1) a, let (a = 1, b = a + 1) a + b, let (a = 1) let (b = 2) a + b, let () 5);
a = 10;
echo(let (a = a + 1) a, let (a = 1, a = a + 1) a, a);
echo(let (f = function(x) x * 2) f(4), let ($x = 3) $x, 1 + (let (z = 2) z * 3));
