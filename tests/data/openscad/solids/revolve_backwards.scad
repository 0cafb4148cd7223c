$fn = 160;
rotate_extrude(angle = -60) translate([10, 0]) polygon([[0, 0], [12, 0], [10, 6], [2, 10]]);
