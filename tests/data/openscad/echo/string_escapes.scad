echo("tab\tend", "quote\"end", "back\\slash");
echo("new\nline");
echo("\x41\x7a\x20", "\u00e9\u20ac", "\U01F600");
echo(len("\u00e9\u20ac"), len("\U01F600"), len("\t\n\\\""));
echo("carriage\rreturn");
