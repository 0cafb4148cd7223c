$fn = 64;
linear_extrude(4)
  projection() { sphere(10); translate([12, 0, 15]) rotate([0, 50, 0]) cylinder(h = 20, r = 4); translate([-30, -5, 3]) cube(12); }
