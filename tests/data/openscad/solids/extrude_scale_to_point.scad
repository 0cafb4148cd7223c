linear_extrude(height = 24, scale = 0) square([20, 14], center = true);
