linear_extrude(height = 50, twist = 20, scale = 1.4, slices = 100)
  difference() { circle(14, $fn = 8); circle(12, $fn = 8); }
