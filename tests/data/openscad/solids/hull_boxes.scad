hull() { cube([20, 16, 2]); translate([6, 4, 18]) cube([6, 5, 2]); }
