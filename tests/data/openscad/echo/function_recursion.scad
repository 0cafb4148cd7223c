function fact(n) = n <= 1 ? 1 : n * fact(n - 1);
function fib(n) = n < 2 ? n : fib(n - 1) + fib(n - 2);
function gcd(a, b) = b == 0 ? a : gcd(b, a % b);
function even(n) = n == 0 ? true : odd(n - 1);
function odd(n) = n == 0 ? false : even(n - 1);
echo(fact(10), fact(20), fact(170), fib(15), gcd(48, 36), even(100), odd(7));
