for (a = [-720 : 30 : 720]) echo(a, sin(a), cos(a), tan(a));
