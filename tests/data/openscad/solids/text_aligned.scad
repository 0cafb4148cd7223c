$fn = 40;
linear_extrude(6) text("Hub", size = 16, halign = "center", valign = "center");
translate([-3, 14]) linear_extrude(6) text("To", size = 12, halign = "right", valign = "bottom");
translate([3, -10]) linear_extrude(6) text("ig", size = 12, valign = "top");
