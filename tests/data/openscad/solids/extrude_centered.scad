linear_extrude(height = 14, center = true) polygon([[0, 0], [20, 0], [14, 14], [0, 10]]);
