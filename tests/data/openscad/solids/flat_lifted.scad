// Heights mean nothing to what is flat.
linear_extrude(5) translate([3, 4, 50]) square([10, 6]);
