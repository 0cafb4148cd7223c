// The cut ends in the faces of what it cuts.
difference() { cube([20, 20, 10]); translate([5, 5, 0]) cube([10, 10, 10]); }
