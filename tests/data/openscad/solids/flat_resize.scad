$fn = 200;
linear_extrude(5) resize([30, 12]) circle(10);
translate([0, 20]) linear_extrude(5) resize([30, 0], auto = true) square([10, 4]);
translate([0, 40]) linear_extrude(5) resize([0, 9]) polygon([[0, 0], [20, 0], [5, 20]]);
