module row(step) for (i = [0 : $children - 1]) translate([step * i, 0, 0]) children(i);
module lid() difference() { children(0); translate([0, 0, 3]) children([1 : $children - 1]); }
row(25) { cube(10); translate([5, 5, 0]) cylinder(h = 14, r = 5, $fn = 48); cube([12, 4, 20]); }
translate([0, 30, 0]) lid() { cube([30, 12, 6]); translate([2, 2, 0]) cube([8, 8, 8]); translate([16, 2, 0]) cube([10, 8, 8]); }
