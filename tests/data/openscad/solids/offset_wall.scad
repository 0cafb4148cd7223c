// A wall of even thickness: the figure less its own inside.
$fn = 200;
module plan() difference() { square([40, 30]); translate([20, 30]) circle(9); }
linear_extrude(12) difference() { plan(); offset(delta = -2.5) plan(); }
