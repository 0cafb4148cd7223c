// all of them are multmatrix there
mirror([1, 1, 0]) rotate([10, 20, 30]) scale([1, 2, 0.5]) translate([3, 2, 1]) cube([4, 3, 2]);
rotate(a = 40, v = [1, 1, 1]) translate([15, 0, 0]) cylinder(h = 6, r = 2);
multmatrix([[1, 0.3, 0, -12], [0, 1, 0, 0], [0, 0.2, 1, 0], [0, 0, 0, 1]]) cube(5);
