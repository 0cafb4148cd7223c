$fn = 100;
hull() for (x = [0, 30], y = [0, 18]) translate([x, y, 0]) cylinder(h = 5, r = 4);
