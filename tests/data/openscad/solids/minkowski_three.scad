minkowski() { cube([12, 3, 3]); cube([2, 10, 2]); rotate([0, 0, 45]) cube(4, center = true); }
