// Files that use each other, and this one.
use <lib/circle_a.scad>
use <lib/circle_b.scad>
function own() = "own";
echo(down(5), from_scene());
