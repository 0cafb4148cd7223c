module m() echo($children);
m();
m() cube();
m() { cube(); sphere(); }
m() { cube(); if (true) sphere(); for (i = [0 : 3]) cube(i + 1); }
m() { }
m() { a = 1; echo(a); }
m() { ; ; }
m() union() { cube(); sphere(); }
