echo(search("a", 5));
echo(search(undef, [1]), search(true, [true]), search(1), search(), search(1, undef));
echo(search("a", ["a", "b"]), search("b", ["a", "b"], 0), search("ab", ["a", "b"]), search(["ab"], ["ab", "c"]));
echo(search(1, "abc"), search([1], "123"), search(["a"], "abc"));
