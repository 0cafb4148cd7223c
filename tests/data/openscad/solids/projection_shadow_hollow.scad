$fn = 64;
linear_extrude(4) projection() difference() { cylinder(h = 10, r = 20); translate([0, 0, -1]) cylinder(h = 12, r = 12); }
