intersection_for(a = [[0, 0, 0], [45, 0, 0], [0, 45, 0], [0, 0, 45]]) rotate(a) cube(20, center = true);
