echo("before");
module m(x) { assert(x > 0, str("x is ", x)); echo("in m", x); }
m(1);
m(-1);
echo("after");
