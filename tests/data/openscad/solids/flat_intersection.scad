$fn = 200;
linear_extrude(6) intersection() { circle(20); translate([15, 0]) circle(20); square([40, 24], center = true); }
