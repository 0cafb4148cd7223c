// names, lists, alpha; on groups
color("teal") cube(4);
color([1, 0.5, 0], 0.4) translate([6, 0, 0]) { sphere(2); cube(1); }
color("#a0b0c0") translate([0, 6, 0]) cylinder(h = 3, r = 2);
