linear_extrude(height = 8, convexity = 10, center = false) { square(6); translate([10, 0]) square([4, 9]); if (false) square(90); }
linear_extrude(center = true, height = 12) translate([0, 20]) square(8);
