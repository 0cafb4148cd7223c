for (n = [10 : 16]) translate([12 * (n % 3), 12 * floor(n / 3)]) linear_extrude(7) circle(5, $fn = n);
