include <lib/../lib/defs.scad>
echo(lib_variable);
