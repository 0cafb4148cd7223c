$fn = 60;
difference() {
  union() {
    cube([30, 20, 3]);
    cube([3, 20, 24]);
    translate([0, 8.5, 0]) rotate([90, 0, 0]) mirror([0, 0, 1]) linear_extrude(3) polygon([[3, 3], [20, 3], [3, 20]]);
  }
  for (y = [4, 16]) translate([22, y, -1]) cylinder(h = 6, r = 1.8);
  translate([-1, 10, 18]) rotate([0, 90, 0]) cylinder(h = 6, r = 2.2);
}
