$fn = 80;
minkowski() { cube([20, 14, 4]); cylinder(h = 6, r1 = 5, r2 = 1); }
