$fn = 64;
intersection() { cube(16, center = true); sphere(10.5); }
translate([25, 0, 0]) intersection() { cylinder(h = 20, r = 6, center = true); rotate([90, 0, 0]) cylinder(h = 20, r = 6, center = true); }
