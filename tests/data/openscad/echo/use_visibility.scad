use <lib/defs.scad>
echo(lib_function(2));
lib_module();
echo(is_undef(lib_variable));
