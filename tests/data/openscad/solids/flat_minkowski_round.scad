$fn = 200;
linear_extrude(6) minkowski() { polygon([[0, 0], [30, 0], [30, 10], [10, 10], [10, 24], [0, 24]]); circle(4); }
