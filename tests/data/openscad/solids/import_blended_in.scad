union() { import("block.stl"); translate([4, 4, 6]) cylinder(h = 14, r = 3, $fn = 64); }
