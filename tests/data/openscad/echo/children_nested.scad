module a() { b() children(); }
module b() { echo("b", $children); children(); }
a() { echo("x"); echo("y"); }
module twice() { children(); children(); }
twice() twice() echo("four times");
