for (i = [0 : 3]) if (i % 2) echo("odd", i); else { echo("even", i); }
if (true) { } else echo("no");
if ([]) echo("no"); else if (undef) echo("no"); else if ("x") echo("string");
