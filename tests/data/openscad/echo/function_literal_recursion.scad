fact = function(n) n <= 1 ? 1 : n * fact(n - 1);
echo(fact(5));
y = function(self, n) n == 0 ? 0 : n + self(self, n - 1);
echo(y(y, 10));
loop = function(n, a = 0) n == 0 ? a : loop(n - 1, a + 1);
echo(loop(20000));
