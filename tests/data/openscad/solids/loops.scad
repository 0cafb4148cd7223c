for (i = [0 : 3], j = [0 : 2]) translate([10 * i, 10 * j, 0]) cube([6, 6, 2 + i + 2 * j]);
for (p = [[0, -12, 3], [15, -12, 5]]) translate([p.x, p.y, 0]) cube(p.z);
