// Angles about all three axes at once: x first, then y, then z.
rotate([90, 0, 90]) translate([3, 4, 5]) cube([10, 6, 4]);
rotate([0, 45, 0]) translate([25, 0, 0]) rotate([0, 0, 45]) cube([8, 8, 3], center = true);
rotate([15, 25, 35]) translate([0, 0, 25]) cylinder(h = 6, r1 = 6, r2 = 3, $fn = 4);
