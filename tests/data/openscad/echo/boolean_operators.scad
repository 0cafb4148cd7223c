echo(true && true, true && false, 1 && "a", 0 || "", [] || 3, undef || false, undef && true);
echo(true || false && false, (true || false) && false, !true || true, !(true || true));
echo(1 && 2 && 3, 0 || 0 || 7);
function f(x) = echo("called", x) x;
echo(f(false) && f(true), f(true) || f(false), f(true) && f(false));
