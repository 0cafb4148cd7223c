for (n = [9, 10, 13, 16]) translate([14 * (n % 2), 5 * n, 0]) sphere(6, $fn = n);
