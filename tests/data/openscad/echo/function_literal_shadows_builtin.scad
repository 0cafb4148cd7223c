sin = function(x) "my sin";
echo(sin(30), cos(60));
max = 7;
echo(max, max(1, 2));
module m(len) echo(len("abc"));
m(function(x) "parameter len");
m(5);
