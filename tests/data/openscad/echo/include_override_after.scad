include <lib/defs.scad>
lib_variable = "scene after";
echo(lib_variable, lib_function(1));
lib_module();
