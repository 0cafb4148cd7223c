difference() { cube([20, 20, 10]); translate([5, 5, 6]) cube([10, 10, 4]); translate([0, 8, 0]) cube([20, 4, 3]); }
