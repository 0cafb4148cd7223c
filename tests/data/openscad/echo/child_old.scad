module m() { child(); child(1); }
m() { echo("c0"); echo("c1"); }
module n() child(7);
n() echo("x");
