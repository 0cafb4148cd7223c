module m(a) { a = 10; echo(a); }
m(3);
module n(a) { a = a + 1; echo(a); }
n(3);
module o(a = 1) { b = a; a = 2; echo(a, b); }
o();
