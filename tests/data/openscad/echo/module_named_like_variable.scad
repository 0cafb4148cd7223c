r = 5;
module r(r = r) echo(r);
r();
r(7);
r(r = r + 1);
