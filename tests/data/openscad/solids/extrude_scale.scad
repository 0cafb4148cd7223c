linear_extrude(height = 20, scale = 0.4) polygon([[-10, -10], [14, -10], [14, 8], [0, 8], [0, 14], [-10, 14]]);
