$fn = 100;
scale([2, 1, 0.5]) sphere(10);
