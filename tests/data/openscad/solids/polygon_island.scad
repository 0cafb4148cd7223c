// An island in a hole, and an outline apart.
outer = [[-20, -20], [20, -20], [20, 20], [-20, 20]];
linear_extrude(5)
  polygon(concat(outer, 0.7 * outer, 0.4 * outer, [[25, 0], [35, 0], [30, 12]]),
          [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11], [12, 13, 14]]);
