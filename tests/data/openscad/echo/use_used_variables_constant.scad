use <lib/constants.scad>
echo(pick(0), pick(2), pick(9));
