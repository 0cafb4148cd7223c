module tree(n, s) {
  cube([s, s, 3 * s]);
  if (n > 0) translate([s / 4, s / 4, 3 * s]) { tree(n - 1, s / 2); translate([0, 0, -s]) rotate([0, 60, 40]) tree(n - 1, s / 2); }
}
tree(3, 8);
