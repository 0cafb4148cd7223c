// children by index, special variables, functions
function r(i) = 1 + sin(i * 30);
module pick(i) { translate([8 * i, 0, 0]) children(i); }
for (i = [0 : 2]) pick(i) { cube(r(i)); sphere(r(i)); cylinder(h = 3, r = r(i), $fn = 8); }
