$fn = 40;
minkowski() { cube([20, 14, 8]); sphere(4); }
