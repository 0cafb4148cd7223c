module count(n) { echo(n); if (n > 0) count(n - 1); }
count(3);
module tree(n) if (n > 0) { echo(n); tree(n - 1); tree(n - 1); }
tree(3);
