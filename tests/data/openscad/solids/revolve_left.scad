// A figure left of the axis.
$fn = 120;
rotate_extrude() translate([-20, 0]) square([8, 5]);
translate([0, 0, 12]) rotate_extrude(angle = 100) translate([-20, 0]) square([8, 5]);
