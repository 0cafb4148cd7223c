ops = [["add", function(a, b) a + b], ["mul", function(a, b) a * b]];
function apply(name, a, b) = let (i = search([name], ops)[0]) ops[i][1](a, b);
echo(apply("add", 2, 3), apply("mul", 2, 3));
map = function(f, v) [for (x = v) f(x)];
fold = function(f, v, start, i = 0) i == len(v) ? start : fold(f, v, f(start, v[i]), i + 1);
echo(map(function(x) x ^ 2, [1, 2, 3]), fold(function(a, b) a + b, [1, 2, 3, 4], 0));
