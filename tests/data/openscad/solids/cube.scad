cube(10);
translate([15, 0, 0]) cube([6, 14, 3]);
translate([40, 8, 0]) cube([12, 8, 10], center = true);
