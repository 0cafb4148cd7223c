include <lib/one.scad>
function which_f() = "scene";
module which() echo("scene module");
which();
echo(which_f());
