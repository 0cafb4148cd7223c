$fn = 64;
difference() {
  difference() {
    difference() { cube([30, 20, 12]); translate([3, 3, 3]) cube([24, 14, 20]); }
    translate([15, -1, 7]) rotate([-90, 0, 0]) cylinder(h = 30, r = 3);
  }
  translate([-1, 10, 7]) rotate([0, 90, 0]) cylinder(h = 50, r = 2);
  translate([25, 15, -1]) cylinder(h = 5, r = 1.5);
}
