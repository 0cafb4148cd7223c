// a deep tree of groups
module tree(n, s) { cylinder(h = s, r = s / 8); if (n > 0) for (a = [0, 120, 240]) rotate([0, 0, a]) translate([0, 0, s * 0.9]) rotate([35, 0, 0]) tree(n - 1, s * 0.7); }
tree(3, 10);
