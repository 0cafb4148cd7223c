echo("1" == 1, "true" == true, "a" == ["a"], "" == undef, "" == false);
echo("1" < 2);
echo("a" < true, "a" < [1], "a" > undef);
