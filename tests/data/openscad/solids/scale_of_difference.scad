$fn = 72;
scale([1, 1.6, 0.7]) difference() { cylinder(h = 20, r = 12); translate([0, 0, -1]) cylinder(h = 30, r = 8); }
