echo();
echo(1);
echo(a = 1, b = 2);
echo("label", 1, x = [1, 2]);
echo(undef);
echo("") ;
echo("quoted", str("inner \"quotes\""));
echo([["nested", 1], "text"]);
echo(1, , 2);
