// what makes nothing stays as group()
module nothing() { }
if (false) cube(3); else nothing();
for (i = [0 : 2]) if (i > 0) translate([6 * i, 0, 0]) cube(4);
union() { }
group() { sphere(3); }
echo("not in the tree");
