// Only the sign of the angle differs: clockwise seen from above, then the other way.
$fn = 60;
for (i = [0, 1]) translate([40 * i, 0, 0]) linear_extrude(height = 20, twist = i == 0 ? 70 : -70, slices = 60) translate([8, 0]) scale([1, 0.5]) circle(6);
