linear_extrude(6) minkowski() { square([20, 12]); circle(5, $fn = 6); }
translate([50, 0]) linear_extrude(6)
  minkowski() { polygon([[0, 0], [20, 0], [20, 5], [5, 5], [5, 20], [0, 20]]); polygon([[0, 0], [6, 0], [0, 4]]); }
