resize([20, 30, 10]) sphere(5, $fn = 100);
