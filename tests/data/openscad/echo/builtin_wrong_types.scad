echo(sin("a"), cos([1]), sqrt("4"), abs(true), floor("1.5"), round([1]), sign(undef), ln("e"), exp([]));
echo(norm("a"), len(1), ord(1), chr("a"), pow("2", 2), atan2(1, "x"), cross("a", "b"), concat("a", 1), max("1", 2));
echo(parent_module(0));
