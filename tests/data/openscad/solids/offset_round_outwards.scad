$fn = 200;
linear_extrude(5) offset(r = 4) polygon([[0, 0], [30, 0], [10, 8], [0, 25]]);
