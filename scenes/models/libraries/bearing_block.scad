// A pillow block for a bearing of MCAD (Debian: openscad-mcad), with fillets around it.
//
// The library has the bearing's measures and the bearing itself; what it is held by is blended. `part` makes two meshes: print the block, buy the bearing.
//
//! needs MCAD/bearing.scad
//! expect volume 14128 0.5%
//! expect area 7018 0.5%
//! expect euler -4
//! expect components 2
include <MCAD/bearing.scad>

model = 608;      // of skates
bolt = 5;         // M5
wall = 5;
play = 0.1;       // around the bearing
foot = [64, 18, 7];

outer = bearingOuterDiameter(model) / 2;
width = bearingWidth(model);
axis = foot[2] + outer + wall / 2;

module bolt_hole(x)
  translate([x, 0, -1]) {
    cylinder(h = foot[2] + 2, d = bolt + 0.4);
    translate([0, 0, foot[2] - 1]) cylinder(h = 20, d = 2 * bolt + 1);
  }

part("block")
  color("steelblue")
    difference(blend = 0.6) {                            // edges of holes, soft
      intersection() {
        union(blend = 6) {                               // the fillet between foot and ring
          translate([0, 0, foot[2] / 2]) cube(foot, center = true, round = 1.5);
          translate([0, 0, axis]) rotate([90, 0, 0])
            cylinder(h = width + 3, r = outer + wall, center = true, round = 1);
        }
        translate([-50, -50, 0]) cube(100);
      }
      translate([0, (width + 3) / 2, axis]) rotate([90, 0, 0]) cylinder(h = width + 1, r = outer + play);
      translate([0, 0, axis]) rotate([90, 0, 0]) cylinder(h = 50, r = outer - 3, center = true);
      bolt_hole(-24);
      bolt_hole(24);
    }

part("bearing")
  translate([0, (width + 3) / 2, axis]) rotate([90, 0, 0]) bearing(model = model);
