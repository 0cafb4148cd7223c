// Recursion, list comprehensions and loops over numbers. csgmesh check tests/bench/lists.scad
function fib(n) = n < 2 ? n : fib(n - 1) + fib(n - 2);
function sum(v, i = 0, acc = 0) = i >= len(v) ? acc : sum(v, i + 1, acc + v[i]);
n = 300;
grid = [for (x = [0 : n]) [for (y = [0 : n]) let (dx = x - n / 2, dy = y - n / 2, r = sqrt(dx * dx + dy * dy)) r < n / 2 ? sin(r * 8) * 3 : 0]];
primes = [for (i = [2 : 4000]) if (len([for (j = [2 : 1 : floor(sqrt(i))]) if (i % j == 0) 1]) == 0) i];
flat = [for (row = grid) each row];
echo(fib(21), sum(flat), len(primes), max(flat));
c = [for (i = 0, a = 0, b = 1; i < 60000; i = i + 1, a = b % 1000, b = (a + b) % 1000) a];
echo(len(c), c[59999]);
