linear_extrude(4) square(7);
translate([10, 0]) linear_extrude(6) square([3, 12]);
translate([25, 5]) linear_extrude(5) square([9, 6], center = true);
