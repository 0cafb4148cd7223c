s = "hello";
echo(s[0], s[4], s[5], s[-1], s[1.7], s["a"], s[undef], s[true]);
echo(s[[0]], s.x, len(s), ""[0], len(""));
