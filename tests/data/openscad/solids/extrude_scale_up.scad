$fn = 120;
linear_extrude(height = 15, scale = 1.8, center = true) difference() { circle(10); circle(6); }
