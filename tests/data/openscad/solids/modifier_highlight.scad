difference() { cube(12); #translate([3, 3, -1]) cube([6, 6, 20]); }
