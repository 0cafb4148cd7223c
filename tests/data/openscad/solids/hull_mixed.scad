$fn = 64;
hull() { cylinder(h = 3, r = 12); translate([0, 8, 22]) sphere(5); translate([-14, -3, 0]) cube(6); }
