$fn = 100;
linear_extrude(height = 30, twist = 90, slices = 120) difference() { circle(12); translate([3, 0]) scale([1, 0.6]) circle(7); }
