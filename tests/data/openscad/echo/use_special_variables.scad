use <lib/special.scad>
$sp = "scene";
show_special();
show_special($sp = "call");
echo(get_special());
