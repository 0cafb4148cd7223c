// $fn, $fa and $fs come along
cylinder(h = 5, r = 8, $fn = 6);
translate([20, 0, 0]) cylinder(h = 5, r1 = 8, r2 = 4, $fn = 4);
translate([0, 20, 0]) cylinder(h = 5, r = 8, $fa = 5, $fs = 0.5);
translate([20, 20, 0]) sphere(r = 6, $fn = 96);
