include <lib/defs.scad>
include <lib/defs.scad>
echo(lib_function(1));
