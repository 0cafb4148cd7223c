$fn = 100;
linear_extrude(height = 30, scale = [0.6, 1.5], twist = 100, slices = 150, center = true) scale([1.4, 1]) circle(10);
