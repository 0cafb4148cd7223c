$fn = 160;
cylinder(h = 20, r1 = 10, r2 = 0);
translate([25, 0, 0]) cylinder(h = 16, d1 = 6, d2 = 18);
translate([50, 0, 0]) cylinder(10, 0, 9, center = true);
