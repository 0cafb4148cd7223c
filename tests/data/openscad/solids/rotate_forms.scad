module mark() { cube([14, 5, 6]); translate([9, 0, 6]) cube(5); }
rotate(30) mark();
translate([30, 0, 0]) rotate([40, 20, 10]) mark();
translate([50, 0, 0]) rotate(a = 70, v = [1, 1, 0]) mark();
translate([0, 30, 0]) rotate([0, 0, 90]) mark();
translate([30, 30, 0]) rotate([0, 180]) mark();
translate([50, 30, 0]) rotate(-120, [1, 2, 3]) mark();
