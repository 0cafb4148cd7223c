echo(undef == undef, undef != undef, undef == 0, undef == false, undef == "", undef == []);
echo(undef < 1, undef > 1, 1 <= undef, undef < undef, undef >= undef);
