resize([30, 10, 10]) translate([10, 5, 2]) cube([5, 5, 5]);
