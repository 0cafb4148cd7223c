assert(true);
assert(1 + 1 == 2, "math works");
assert(condition = true, message = "named");
assert("non-empty");
assert([0]) echo("with child");
x = assert(true) 5;
echo(x);
function f(n) = assert(n > 0, "positive") n * 2;
echo(f(3));
assert(1) { echo("block"); }
echo(assert(true));
