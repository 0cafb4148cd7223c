module flag() polygon([[0, 0], [12, 0], [9, 3], [12, 6], [0, 6]]);
linear_extrude(4) {
  flag();
  translate([20, 5]) rotate(40) flag();
  translate([40, 0]) mirror([1, 1]) flag();
  translate([45, 5]) scale([1.5, 0.8]) flag();
  translate([0, 25]) multmatrix([[1, 0.5, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) flag();
}
