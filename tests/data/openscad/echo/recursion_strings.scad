function repeat(s, n) = n <= 0 ? "" : str(s, repeat(s, n - 1));
echo(repeat("ab", 3), repeat("x", 0), len(repeat("-", 100)));
function binary(n) = n < 2 ? str(n) : str(binary(floor(n / 2)), n % 2);
echo(binary(10), binary(255), binary(0));
function hex(n) = n < 16 ? "0123456789abcdef"[n] : str(hex(floor(n / 16)), hex(n % 16));
echo(hex(255), hex(4096));
