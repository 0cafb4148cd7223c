// Faces that lie in one plane or touch.
cube([10, 10, 10]);
translate([10, 2, 0]) cube([8, 6, 10]);
translate([0, 0, 10]) cube([10, 5, 4]);
translate([2, 10, 3]) cube([5, 5, 5]);
