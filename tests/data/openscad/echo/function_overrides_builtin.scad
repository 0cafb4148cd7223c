function sin(x) = "mine";
function len(x) = x * 2;
echo(sin(30), len(21), cos(60));
