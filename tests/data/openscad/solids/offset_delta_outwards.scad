linear_extrude(5) offset(delta = 3) polygon([[0, 0], [30, 0], [12, 10], [0, 25]]);
