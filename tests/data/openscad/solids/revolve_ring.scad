$fn = 120;
rotate_extrude() translate([15, 0]) circle(5);
