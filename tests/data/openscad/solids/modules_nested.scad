module post(h) { module cap() translate([0, 0, h]) cube([6, 6, 2], center = true); cylinder(h = h, r = 2, $fn = 60); cap(); }
module pair(h = 12) { post(h); translate([12, 0, 0]) post(h * 1.5); }
pair();
translate([0, 16, 0]) pair(8);
