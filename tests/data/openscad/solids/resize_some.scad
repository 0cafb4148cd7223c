$fn = 80;
resize([0, 0, 30]) cylinder(h = 10, r1 = 8, r2 = 4);
translate([30, 0, 0]) resize([12, 0, 0]) cube([6, 8, 10]);
