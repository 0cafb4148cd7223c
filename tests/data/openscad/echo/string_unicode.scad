s = "aé€😀z";
echo(s, len(s));
for (i = [0 : len(s)]) echo(i, s[i]);
echo([for (c = s) ord(c)]);
echo(chr([97, 233, 8364, 128512]));
echo("日本語"[1], str("日", "本"));
