$fn = 160;
cylinder(20, 8, 8);
translate([25, 0, 0]) cylinder(h = 12, d = 10, center = true);
