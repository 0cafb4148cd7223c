function area(r) = PI * r * r * scale_factor;
scale_factor = 2;
echo(area(1));
