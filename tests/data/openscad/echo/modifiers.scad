*echo("disabled");
%echo("background");
#echo("debug");
echo("plain");
*for (i = [0 : 3]) echo(i);
module m() echo("m");
*m();
#m();
