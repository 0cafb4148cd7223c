module m() { echo($children); children(); }
m() { *echo("off"); echo("on"); }
m() *echo("off");
