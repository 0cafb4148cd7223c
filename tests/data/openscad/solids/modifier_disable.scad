cube(10);
*translate([15, 0, 0]) sphere(10);
translate([0, 15, 0]) { *cube(30); cube([20, 6, 6]); }
