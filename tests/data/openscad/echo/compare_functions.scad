f = function(x) x;
g = function(x) x;
echo(f == f, f == g, f != g, f == 1, f < g);
echo([f] == [f]);
