include <lib/uses_defs.scad>
echo(twice_lib(2), lib_function(5));
