$fn = 200;
linear_extrude(6) hull() { circle(10); translate([30, 0]) circle(5); translate([10, 25]) circle(3); }
