$fn = 64;
resize([40, 0, 12], auto = true) difference() { cylinder(h = 10, r = 10); translate([0, 0, 3]) cylinder(h = 10, r = 7); }
