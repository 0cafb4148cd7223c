$fn = 80;
intersection_for(a = [0, 60, 120]) rotate([0, 0, a]) translate([4, 0, 0]) cylinder(h = 10, r = 12);
