function bezier(p, t) = len(p) == 1 ? p[0] :
    bezier([for (i = [0 : len(p) - 2]) p[i] * (1 - t) + p[i + 1] * t], t);
echo([for (t = [0 : 0.1 : 1]) bezier([[0, 0], [0, 10], [10, 10], [10, 0]], t)]);
