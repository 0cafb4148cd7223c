// area: not compared, OpenSCAD folds a long twisted side into two triangles a slice
linear_extrude(height = 40, twist = 90, slices = 300) square([20, 8], center = true);
