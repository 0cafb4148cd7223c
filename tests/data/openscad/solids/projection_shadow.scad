linear_extrude(4) projection() rotate([30, 40, 10]) cube([20, 16, 24], center = true);
