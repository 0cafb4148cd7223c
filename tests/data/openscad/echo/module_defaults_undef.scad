module m(a = undef, b = [], c = "") echo(is_undef(a), len(b), c == "");
m();
m(a = 1, b = [1], c = "x");
