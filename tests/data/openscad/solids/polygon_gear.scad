teeth = 18;
linear_extrude(8)
  difference() {
    polygon([for (i = [0 : teeth - 1], k = [0 : 3])
               let (r = k == 0 || k == 3 ? 20 : 24, a = (i + [0.1, 0.3, 0.55, 0.75][k]) * 360 / teeth)
                 r * [cos(a), sin(a)]]);
    circle(6, $fn = 200);
  }
