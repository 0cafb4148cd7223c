// flat shapes, extruded
linear_extrude(height = 5, center = true, convexity = 4) difference() { square([20, 10], center = true); circle(3); }
translate([30, 0, 0]) linear_extrude(height = 8, twist = 40, scale = 0.5, slices = 20) square(8, center = true);
translate([0, 30, 0]) rotate_extrude(angle = 270, convexity = 2) translate([6, 0]) square([2, 3]);
translate([30, 30, 0]) linear_extrude(2) offset(r = 1) polygon([[0, 0], [8, 0], [4, 6]]);
translate([60, 0, 0]) linear_extrude(2) polygon(points = [[0, 0], [9, 0], [9, 9], [0, 9], [3, 3], [6, 3], [6, 6], [3, 6]], paths = [[0, 1, 2, 3], [4, 5, 6, 7]]);
