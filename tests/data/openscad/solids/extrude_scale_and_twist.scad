$fn = 100;
linear_extrude(height = 40, scale = 0.5, twist = 180, slices = 150) scale([1.4, 1]) circle(10);
