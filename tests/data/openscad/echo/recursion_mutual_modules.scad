module even(n) { if (n == 0) echo("even"); else odd(n - 1); }
module odd(n) { if (n == 0) echo("odd"); else even(n - 1); }
even(10);
odd(10);
