difference() {
  intersection() { cylinder(h = 8, r = 10, $fn = 6); translate([0, 0, -2.5]) sphere(11, $fn = 100); }
  translate([0, 0, -1]) cylinder(h = 10, d = 8, $fn = 80);
}
