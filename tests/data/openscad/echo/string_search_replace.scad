function replace(s, a, b) = chr([for (c = s) for (o = c == a ? [for (d = b) ord(d)] : [ord(c)]) o]);
echo(replace("banana", "a", "oo"), replace("", "a", "b"), replace("x", "y", "z"));
function split(s, sep, i = 0, word = "") = i == len(s) ? [word] :
    s[i] == sep ? concat([word], split(s, sep, i + 1)) : split(s, sep, i + 1, str(word, s[i]));
echo(split("a,bc,,d", ","));
function number(s, i = 0, n = 0) = i == len(s) ? n : number(s, i + 1, n * 10 + ord(s[i]) - 48);
echo(number("12034"));
