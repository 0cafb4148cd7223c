outer = 12;
inner = 5;
translate([0, 0, 10]) cube(outer / 3, center = true);
