module m() { children(5); children(-1); children(0.9); children([7]); echo("end"); }
m() echo("c");
module n() children(0);
n();
