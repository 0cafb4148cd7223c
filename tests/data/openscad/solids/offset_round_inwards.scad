$fn = 200;
linear_extrude(5) offset(r = -3) polygon([[0, 0], [40, 0], [40, 14], [16, 14], [16, 36], [0, 36]]);
