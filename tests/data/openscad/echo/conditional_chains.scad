function sgn(x) = x > 0 ? "plus" : x < 0 ? "minus" : "zero";
echo(sgn(3), sgn(-3), sgn(0), sgn("a"), sgn(undef));
echo(true ? 1 : foo_undefined, 0 ? "a" : "", [] ? 1 : 2);
