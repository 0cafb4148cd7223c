module cube(s) echo("my cube", s);
cube(3);
module translate(v) { echo("my translate", v); children(); }
translate([1, 2, 3]) cube(4);
