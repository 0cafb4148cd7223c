echo(is_undef(nowhere), is_undef($nowhere));
x = 1;
echo(is_undef(x), is_undef(undef), is_undef([][0]));
module m(a) echo(is_undef(a));
m(); m(1);
