// --exact: not compared, hulls of differences come from a tessellation
// What is cut away inside does not matter to a hull; what is cut off outside does.
hull() difference() { cube([20, 20, 20]); translate([10, 10, 10]) cube(20); translate([4, 4, 4]) cube(5); }
