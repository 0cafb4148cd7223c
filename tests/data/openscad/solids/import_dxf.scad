$fn = 100;
linear_extrude(5) import("plate.dxf");
