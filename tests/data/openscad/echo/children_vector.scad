module m() { children([2, 0]); children([0 : 2 : 2]); children([]); }
m() { echo("c0"); echo("c1"); echo("c2"); }
module r() children([2 : -1 : 0]);
r() { echo("r0"); echo("r1"); echo("r2"); }
module n() children([0, 0, "x", 1]);
n() { echo("n0"); echo("n1"); }
