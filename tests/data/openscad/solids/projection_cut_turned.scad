linear_extrude(4) projection(cut = true) rotate([30, 40, 0]) cube([20, 16, 24], center = true);
