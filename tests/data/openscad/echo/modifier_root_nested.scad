union() { echo("a"); !echo("root"); echo("b"); }
module m() { !echo("m root"); }
m();
