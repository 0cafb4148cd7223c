$fn = 40;
wall = 2;
module tray(size, corner) hull()
  for (x = [corner, size.x - corner], y = [corner, size.y - corner]) translate([x, y, 0]) cylinder(h = size.z, r = corner);
difference() {
  tray([40, 28, 14], 4);
  translate([wall, wall, wall]) tray([40 - 2 * wall, 28 - 2 * wall, 14], 4 - wall);
  translate([-1, 14, 8]) rotate([0, 90, 0]) cylinder(h = 10, r = 2.5);
}
translate([0, 36, 0]) { tray([40, 28, 2], 4); translate([wall, wall, 2]) tray([40 - 2 * wall, 28 - 2 * wall, 1.5], 4 - wall); }
