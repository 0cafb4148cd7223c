// A tree by recursion: 33 000 solids below transforms below transforms. csgmesh check tests/bench/tree.scad
depth = 14;
function turn(i, n) = 360 * i / n;
module branch(d, len, r) {
  if (d > 0) {
    tip = [0, 0, len];
    scale_now = 0.72 + 0.03 * sin(40 * d);
    color([0.4, 0.2 + 0.05 * d, 0.1]) cylinder(h = len, r1 = r, r2 = r * 0.7);
    translate(tip) for (i = [0 : 1]) {
      angle = 25 + 5 * i;
      rotate([angle, 0, turn(i, 2) + 90 * (d % 2)])
        branch(d - 1, len * scale_now, r * 0.7);
    }
  } else {
    color("green") sphere(r = r * 3);
  }
}
branch(depth, 30, 3);
