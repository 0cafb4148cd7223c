// --exact: not compared, curves of DXF follow a tolerance of 0.002 mm, whatever $fn is
$fn = 100;
linear_extrude(5) import("plate.dxf", layer = "holes");
