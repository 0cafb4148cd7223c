$fn = 60;
linear_extrude(height = 24, twist = -360 * 4, slices = 400) translate([1.2, 0]) circle(6);
translate([0, 0, 24]) cylinder(h = 4, r = 9, $fn = 6);
