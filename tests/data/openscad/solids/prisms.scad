for (n = [3 : 8]) translate([14 * (n % 3), 14 * floor(n / 3), 0]) cylinder(h = 4 + n, r = 6, $fn = n);
