use <shared/washer.scad>
include <shared/sizes.scad>
washer(outer, inner);
translate([outer + 8, 0, 0]) washer(8, 3, 6);
