$fn = 60;
linear_extrude(height = 40, twist = -270, slices = 250) translate([8, 0]) circle(6);
