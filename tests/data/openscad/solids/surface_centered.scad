difference() { surface("heights.dat", center = true); translate([0, 0, -6]) cube([3, 3, 30], center = true); }
