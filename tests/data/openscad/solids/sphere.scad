$fn = 160;
sphere(10);
