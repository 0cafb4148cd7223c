$fn = 160;
rotate_extrude(angle = 250) translate([12, 0]) difference() { circle(6); circle(4); }
