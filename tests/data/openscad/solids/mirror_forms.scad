module mark() { cube([14, 3, 5]); translate([11, 0, 5]) cube([3, 6, 2]); }
translate([2, 0, 0]) mark();
mirror([1, 0, 0]) translate([2, 0, 0]) mark();
translate([30, 30, 0]) mirror([1, 1, 0]) mark();
translate([-20, 30, 0]) mirror([1, 2, 3]) mark();
translate([0, 30, 0]) mirror([0, 0, 0]) mark();
