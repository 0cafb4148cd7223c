x = "global";
module m(x) { children(); }
m("module") echo(x);
module w() { x = "w"; m("m") echo(x); }
w();
m("again") { x = "block"; echo(x); }
