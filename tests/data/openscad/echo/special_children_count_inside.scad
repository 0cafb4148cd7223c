module a() { echo("a", $children); children(); }
module b() { a() { children(); children(0); echo("own", $children); } }
b() { echo("x", $children); }
