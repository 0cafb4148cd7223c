scale_of_scene = 4;
use <lib/needs_scene.scad>
echo(scaled(2));
