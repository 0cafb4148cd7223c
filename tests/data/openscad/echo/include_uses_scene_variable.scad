scale_of_scene = 4;
include <lib/needs_scene.scad>
echo(scaled(2));
scaled_module();
