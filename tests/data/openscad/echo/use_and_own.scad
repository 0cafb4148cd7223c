use <lib/one.scad>
module which() echo("own");
which();
echo(which_f());
