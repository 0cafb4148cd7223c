$fn = 200;
linear_extrude(6) difference() { circle(20); translate([7, 0]) circle(5); square([4, 60], center = true); }
