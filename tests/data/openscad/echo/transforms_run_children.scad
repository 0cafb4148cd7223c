translate([1, 2, 3]) echo("translate");
rotate([0, 0, 45]) echo("rotate");
rotate(45) echo("rotate number");
scale(2) echo("scale");
mirror([1, 0, 0]) echo("mirror");
multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) echo("multmatrix");
color("red") echo("color");
color([1, 0, 0, 0.5]) echo("color vector");
translate([1, 0, 0]) rotate([90, 0, 0]) echo("chain");
