linear_extrude(5) offset(delta = 4, chamfer = true) square([30, 20]);
translate([50, 0]) linear_extrude(5) offset(delta = 3, chamfer = true) polygon([[0, 0], [24, 0], [6, 20]]);
