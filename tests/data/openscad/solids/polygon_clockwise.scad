// Either way round is the same figure.
points = [[0, 0], [10, 2], [14, 12], [4, 15]];
linear_extrude(5) polygon(points);
translate([20, 0]) linear_extrude(5) polygon([for (i = [3 : -1 : 0]) points[i]]);
