// Inwards and outwards rounds convex corners, outwards and inwards concave ones.
$fn = 200;
module figure() { square([30, 12]); square([12, 30]); }
linear_extrude(5) offset(r = 3) offset(r = -3) figure();
translate([40, 0]) linear_extrude(5) offset(r = -4) offset(r = 4) figure();
