assign (a = 1) echo(a);
a = 3;
assign (a = a + 1) { echo(a); }
echo(a);
