// render and its convexity
render(convexity = 3) difference() { cube(10); translate([5, 5, 5]) sphere(6); }
