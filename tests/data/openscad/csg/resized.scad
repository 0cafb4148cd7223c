// resize
resize([20, 0, 10], auto = [false, true, false]) cube([5, 4, 3]);
