// hull and minkowski of solids
hull() { translate([0, 0, 0]) sphere(3); translate([12, 0, 0]) sphere(5); }
translate([30, 0, 0]) minkowski() { cube([8, 6, 4]); sphere(1); }
