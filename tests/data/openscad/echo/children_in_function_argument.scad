module m(n = $children) echo(n, $children);
m();
m() { cube(); sphere(); }
