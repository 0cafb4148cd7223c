echo([1, 2, 3].x, [[5]].x.x, "abc".x, 5 .x, undef.y, [0 : 5].x);
r = [1 : 2 : 9];
echo(r.begin, r.step, r.end, r.foo);
