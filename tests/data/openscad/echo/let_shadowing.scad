a = 1;
f = function(a) let (a = a + 1) let (a = a * 10) a;
echo(f(2), let (a = 5) f(a), a);
function g(a) = let (b = a, a = 7) [a, b];
echo(g(1));
