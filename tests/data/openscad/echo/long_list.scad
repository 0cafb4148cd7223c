v = [for (i = [0 : 999]) i];
echo(len(v), v[999]);
function sum(v, i = 0, s = 0) = i == len(v) ? s : sum(v, i + 1, s + v[i]);
echo(sum(v));
echo([for (i = [0 : 30]) i]);
