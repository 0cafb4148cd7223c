$fn = 100;
minkowski() { cube([20, 14, 4]); cylinder(h = 3, r = 4); }
