function join(v, sep = ", ", i = 0) = i >= len(v) ? "" : str(i == 0 ? "" : sep, v[i], join(v, sep, i + 1));
echo(join(["a", "b", "c"]), join([1, 2, 3], "-"), join([]));
function reverse(s) = chr([for (i = [len(s) - 1 : -1 : 0]) ord(s[i])]);
echo(reverse("hello"), reverse(""));
function substr(s, i, n) = chr([for (k = [i : 1 : i + n - 1]) ord(s[k])]);
echo(substr("abcdef", 2, 3));
function upper(s) = chr([for (c = s) let (o = ord(c)) o >= 97 && o <= 122 ? o - 32 : o]);
echo(upper("Hello World"));
