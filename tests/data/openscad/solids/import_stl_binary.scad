translate([5, 0, 2]) rotate([0, 0, 30]) import("wedge.stl");
