minkowski() {
  linear_extrude(8) polygon([[0, 0], [24, 0], [24, 6], [6, 6], [6, 20], [0, 20]]);
  cube([3, 4, 5], center = true);
}
