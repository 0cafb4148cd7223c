$fn = 200;
linear_extrude(4) offset(r = 2.5) difference() { circle(20); translate([8, -3]) square([20, 6]); circle(8); }
