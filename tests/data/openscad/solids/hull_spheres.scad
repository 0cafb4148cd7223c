$fn = 60;
hull() { sphere(8); translate([25, 0, 5]) sphere(4); translate([5, 20, 0]) sphere(5); }
