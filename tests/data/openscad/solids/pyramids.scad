cylinder(h = 20, r1 = 10, r2 = 0, $fn = 4);
translate([25, 0, 0]) cylinder(h = 15, r1 = 10, r2 = 5, $fn = 6);
translate([50, 0, 0]) cylinder(h = 15, r1 = 4, r2 = 10, $fn = 3, center = true);
