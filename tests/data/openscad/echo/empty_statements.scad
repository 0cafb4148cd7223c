;;
{ }
{ ; }
echo("a");;
module m() { ; }
m();;
{ { echo("nested"); } }
