$fn = 120;
linear_extrude(height = 40, twist = 120, slices = 150) scale([2, 0.8]) circle(8);
