f = function() $q;
module m() { $q = 3; echo(f()); }
m();
echo(f($q = 4));
