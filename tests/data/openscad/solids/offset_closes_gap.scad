$fn = 200;
linear_extrude(4) offset(r = 2) { square(10); translate([13, 0]) square(10); translate([32, 0]) square(10); }
