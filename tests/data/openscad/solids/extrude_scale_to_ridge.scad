linear_extrude(height = 20, scale = [0, 1]) square([20, 24], center = true);
