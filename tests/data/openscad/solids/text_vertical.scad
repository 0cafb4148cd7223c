$fn = 40;
linear_extrude(4) text("EH", size = 14, direction = "ttb");
