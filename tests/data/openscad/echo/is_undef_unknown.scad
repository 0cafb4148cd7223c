// Asking whether a name is defined is no use of it.
echo(is_undef($nobody), is_undef(nothing), is_undef(PI), is_undef(undef));
here = 1;
echo(is_undef(here), is_undef(here[3]));
function f(x) = is_undef(x) ? "none" : x;
echo(f(), f(2));
module m() { echo(is_undef($given)); }
m();
m($given = 3);
