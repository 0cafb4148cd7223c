a = 1;
{ a = 2; echo(a); b = 5; }
echo(a, b);
union() { a = 3; echo(a); }
echo(a);
if (true) { a = 4; echo(a); c = 6; echo(c); }
echo(a);
