$fn = 200;
linear_extrude(5) scale([2, 0.7]) circle(10);
translate([0, 22]) linear_extrude(5) rotate(30) scale([0.5, 1.2]) difference() { circle(10); circle(6); }
