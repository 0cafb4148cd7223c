echo(["a\tb", "c\"d", "e\\f"], [["\n"]]);
echo(str(["a\"b"]), "\u0041\x42");
