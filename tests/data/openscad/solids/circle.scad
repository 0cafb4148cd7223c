$fn = 200;
linear_extrude(5) circle(10);
translate([20, 0]) linear_extrude(8) circle(d = 12);
