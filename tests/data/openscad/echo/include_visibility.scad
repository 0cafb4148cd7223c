include <lib/defs.scad>
echo(lib_variable, lib_function(2));
lib_module();
