use <lib/uses_defs.scad>
echo(twice_lib(2));
