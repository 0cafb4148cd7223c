rotate_extrude(angle = 120, $fn = 9) translate([8, 0]) square([6, 10]);
