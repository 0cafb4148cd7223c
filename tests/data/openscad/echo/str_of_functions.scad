f = function(x) x + 1;
echo(str(f), f, [f]);
echo(function() 1, function(a, b = 2) a * b);
