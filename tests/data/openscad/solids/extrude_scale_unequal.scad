$fn = 120;
linear_extrude(height = 25, scale = [0.3, 1.4], slices = 40) circle(10);
