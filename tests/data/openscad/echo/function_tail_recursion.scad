function count(n, a = 0) = n == 0 ? a : count(n - 1, a + n);
echo(count(10), count(100000));
function build(n, s = "") = len(s) >= n ? s : build(n, str(s, "x"));
echo(len(build(500)));
function through_let(n) = let (m = n - 1) m < 0 ? "end" : through_let(m);
echo(through_let(20000));
