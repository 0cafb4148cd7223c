use <lib/one.scad>
use <lib/two.scad>
which();
echo(which_f());
