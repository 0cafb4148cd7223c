use <defs.scad>
function twice_lib(x) = lib_function(x * 2);
