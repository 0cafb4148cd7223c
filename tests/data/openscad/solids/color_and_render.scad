color("teal") cube(10);
render(convexity = 4) difference() { translate([15, 0, 0]) cube(10); translate([18, 3, -1]) color([1, 0.5, 0]) cube([4, 4, 20]); }
color("#ff8000", 0.5) translate([30, 0, 0]) { cube([4, 10, 10]); translate([8, 0, 0]) cube([4, 10, 10]); }
