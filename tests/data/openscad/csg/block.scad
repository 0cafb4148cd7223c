// difference, cylinders, centred cubes
difference() { cube([30, 20, 10], center = true); for (x = [-10, 0, 10]) translate([x, 0, -6]) cylinder(h = 12, d = 6); }
