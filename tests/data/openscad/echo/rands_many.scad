v = rands(-5, 5, 2000, 7);
echo(v[0], v[623], v[624], v[1247], v[1248], v[1999], len(v));
function sum(v, i = 0, s = 0) = i == len(v) ? s : sum(v, i + 1, s + v[i]);
echo(sum(v));
