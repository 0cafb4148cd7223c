function is_prime(n, d = 2) = d * d > n ? n > 1 : n % d == 0 ? false : is_prime(n, d + 1);
echo([for (i = [0 : 40]) if (is_prime(i)) i]);
function sieve(n) = [for (i = [2 : n]) if ([for (j = [2 : 1 : sqrt(i)]) if (i % j == 0) j] == []) i];
echo(sieve(30));
