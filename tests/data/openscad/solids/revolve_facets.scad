rotate_extrude($fn = 6) translate([8, 0]) square([6, 10]);
translate([40, 0, 0]) rotate_extrude($fn = 5) polygon([[0, 0], [12, 0], [5, 10], [0, 14]]);
