cube(40);
translate([5, 5, 5]) rotate(20) !cube([10, 6, 8]);
