for (i = [0 : 4])
  translate([14 * i, 0, 0])
    if (i % 3 == 0) cube(10);
    else if (i % 3 == 1) cylinder(h = 10, r = 5, $fn = 64);
    else let (s = 4 + i) cube([s, s, 2 * s]);
