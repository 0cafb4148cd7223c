$fn = 200;
linear_extrude(6) hull() { square([10, 4]); translate([25, 20]) circle(6); polygon([[-10, 15], [-4, 18], [-8, 25]]); }
