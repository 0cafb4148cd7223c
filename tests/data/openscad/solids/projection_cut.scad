$fn = 96;
linear_extrude(5)
  projection(cut = true)
    translate([0, 0, -4]) difference() { cylinder(h = 20, r1 = 20, r2 = 5); cylinder(h = 50, r = 4, center = true); }
