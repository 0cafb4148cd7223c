let (a = 1, b = a * 2) { echo(a, b); }
let (a = 5) echo(a);
let () echo("none");
a = 7;
let (a = a + 1) { b = a; echo(a, b); }
echo(a);
