r = [0 : 2 : 8];
echo(is_list(r), is_num(r), r == [0 : 2 : 8], [for (x = r) x * r[1]]);
function f(r) = [for (i = r) i];
echo(f(r), f([10 : 12]));
module m(r) for (i = r) echo(i);
m([1 : 2]);
