lib_variable = "scene before";
include <lib/defs.scad>
echo(lib_variable);
lib_module();
