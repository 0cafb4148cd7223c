$fn = 120;
points = [[0, 0], [20, 10], [35, 0], [45, 25]];
linear_extrude(3)
  for (i = [0 : 2]) hull() { translate(points[i]) circle(4 - i); translate(points[i + 1]) circle(3 - i); }
