scale([1, 1, 0.1]) surface("dots.png", invert = true, center = true);
