echo("first
second");
s = "a
b";
echo(len(s), s[1] == "\n");
