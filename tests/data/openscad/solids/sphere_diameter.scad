translate([3, 4, 5]) sphere(d = 15, $fn = 150);
