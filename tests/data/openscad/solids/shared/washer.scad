module washer(outer, inner, height = 2)
  difference() {
    cylinder(h = height, r = outer, $fn = 120);
    translate([0, 0, -1]) cylinder(h = height + 2, r = inner, $fn = 120);
  }
cube(100);
