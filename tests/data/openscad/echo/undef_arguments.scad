function f(a, b = 5) = [a, b];
echo(f(), f(undef), f(1, undef), f(b = undef), f(b = 2));
module m(a = 3, b) echo(a, b);
m(); m(undef, undef); m(b = 1); m(a = undef);
