resize([30, 0, 0], auto = true) cube([10, 6, 4]);
translate([0, 30, 0]) resize([30, 0, 8], auto = [false, true, false]) cube([10, 6, 4]);
translate([0, -30, 0]) resize([0, 12, 0], auto = [true, true, false]) cube([10, 6, 4]);
