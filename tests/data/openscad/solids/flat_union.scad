$fn = 200;
linear_extrude(6) { circle(10); translate([12, 0]) circle(8); translate([-14, -3]) square([14, 6]); }
