$fn = 160;
rotate_extrude(angle = 90) translate([10, 0]) square([8, 12]);
