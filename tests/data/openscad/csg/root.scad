// ! leaves only this
cube(5);
translate([10, 0, 0]) !union() { sphere(3); translate([3, 0, 0]) cube(2); }
