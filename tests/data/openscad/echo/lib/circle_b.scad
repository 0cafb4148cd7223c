use <circle_a.scad>
use <../use_circle.scad>
function step(n) = down(n) + 1;
function from_scene() = own();
