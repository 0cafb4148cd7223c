x = "global";
module show() echo(x);
module m() { x = "local"; show(); echo(x); }
m();
function get() = x;
module n() { x = "n"; echo(get()); }
n();
