$fn = 40;
linear_extrude(5) text("BOX", size = 18, font = "Liberation Sans:style=Bold", spacing = 1.3);
