// cones, modules, children
module ring(n, r) for (i = [0 : n - 1]) rotate([0, 0, 360 * i / n]) translate([r, 0, 0]) children();
cylinder(h = 20, r1 = 12, r2 = 4);
ring(6, 12) cylinder(h = 10, r1 = 3, r2 = 0);
translate([0, 0, 20]) sphere(4);
