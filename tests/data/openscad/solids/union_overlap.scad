$fn = 64;
union() { cube(12); translate([12, 12, 12]) sphere(7); translate([6, 6, 0]) cylinder(h = 25, r = 3); }
