$fn = 24;
difference() {
  cube([64, 24, 6]);
  translate([4, 4, 3]) linear_extrude(4) text("Cut", size = 16);
}
translate([0, 30, 0]) {
  cube([64, 24, 3]);
  translate([4, 4, 3]) linear_extrude(3) text("Rise", size = 16);
}
