// --exact: not compared, OpenSCAD has its own few steps for curves of SVG, whatever $fn is
$fn = 100;
linear_extrude(5) import("figure.svg", center = true);
