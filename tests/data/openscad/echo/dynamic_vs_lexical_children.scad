$d = "outer";
l = "outer";
module m() { $d = "m"; l = "m"; children(); }
m() { echo($d, l); }
m() m() echo($d);
module n() { $d = "n"; m() echo($d); echo($d); }
n();
