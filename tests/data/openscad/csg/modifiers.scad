// * goes, # stays, % goes from the solid
difference() { cube(10); #translate([5, 5, -1]) cylinder(h = 12, r = 2); }
*cube(100);
%translate([20, 0, 0]) sphere(5);
