use <lib/defs.scad>
lib_variable = "scene";
lib_module();
echo(lib_function(3));
