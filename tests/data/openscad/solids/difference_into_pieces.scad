difference() { cube([30, 10, 10]); for (x = [6, 18]) translate([x, -1, -1]) cube([3, 12, 12]); }
