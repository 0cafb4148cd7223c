$fn = 100;
rotate_extrude() difference() { union() { square([18, 2]); square([9, 22]); translate([0, 20]) square([18, 2]); } translate([-1, -1]) square([5, 30]); }
