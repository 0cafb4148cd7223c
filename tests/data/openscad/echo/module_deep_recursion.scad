module deep(n) { if (n > 0) deep(n - 1); else echo("bottom"); }
deep(400);
