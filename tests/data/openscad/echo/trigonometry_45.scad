for (a = [-405 : 45 : 405]) echo(a, sin(a), cos(a), tan(a));
echo(sin(30) == 0.5, cos(60) == 0.5, sin(180) == 0, cos(90) == 0, tan(45) == 1, sin(45) == cos(45), tan(135) == -1);
