scale([-1, 1, 2]) { cube([10, 6, 4]); cube([4, 12, 4]); }
translate([20, 0, 0]) scale(1.5) cube([6, 4, 2]);
