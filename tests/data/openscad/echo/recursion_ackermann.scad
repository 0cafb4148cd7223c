function ack(m, n) = m == 0 ? n + 1 : n == 0 ? ack(m - 1, 1) : ack(m - 1, ack(m, n - 1));
echo(ack(0, 5), ack(1, 5), ack(2, 3), ack(2, 4));
function hanoi(n, a = "A", b = "B", c = "C") = n == 0 ? [] : concat(hanoi(n - 1, a, c, b), [str(a, c)], hanoi(n - 1, b, a, c));
echo(hanoi(3), len(hanoi(6)));
