// intersection_for too
intersection() { sphere(10); cube(15, center = true); cylinder(h = 20, r = 9, center = true); }
translate([30, 0, 0]) intersection_for(n = [0 : 5]) rotate([0, 0, n * 60]) translate([5, 0, 0]) sphere(r = 12);
