$v = 0;
module show(n) echo(n, $v);
module deep(n) { $v = n; show(n); if (n > 0) deep(n - 1); show(n); }
deep(3);
echo($v);
