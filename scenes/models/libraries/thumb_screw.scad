// A thumb screw: a thread of BOSL2 (github.com/BelfrySCAD/BOSL2), a soft head around it.
//
// threaded_rod is a polyhedron; the head's lobes are joined by one blend, and rounded by another with a half-space.
//
//! needs BOSL2/std.scad
//! expect volume 3050 0.5%
//! expect area 1777 0.5%
//! expect euler 2
//! expect components 1
include <BOSL2/std.scad>
include <BOSL2/threading.scad>

diameter = 8;     // M8
pitch = 1.25;
length = 20;      // of the thread
lobes = 5;
head = 7;         // how high it is

color("darkorange")
  intersection(blend = 1.2) {
    union(blend = 3) {
      cylinder(h = head + 4, r = 8, center = true);
      for (i = [0 : lobes - 1])
        rotate(360 / lobes * i) translate([8, 0, 0]) cylinder(h = head + 4, r = 3.5, center = true);
    }
    cube([60, 60, head], center = true);
  }
translate([0, 0, head / 2 - 0.01])
  threaded_rod(d = diameter, l = length, pitch = pitch, anchor = BOTTOM, bevel2 = true, $fn = 48);
