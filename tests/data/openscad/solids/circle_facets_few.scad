// A $fn up to 16 asks for a polygon; its first corner lies on the x axis.
for (n = [3 : 9]) translate([12 * (n % 3), 12 * floor(n / 3)]) linear_extrude(7) circle(5, $fn = n);
