include <lib/one.scad>
include <lib/two.scad>
which();
echo(which_f());
