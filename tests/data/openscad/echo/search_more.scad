echo(search("a", [["apple", 1], ["bat", 2], ["ant", 3]], 0), search("ab", [["apple", 1], ["bat", 2]], 0), search("1", [[12], [21], [1]], 0));
echo(search([], []), search("", []), search("x", []), search([1], []), search(1, []));
echo(search(1, [1, 1, 1], "a"), search(1, [1, 1, 1], -1), search([1], [1, 1], 1.9), search(true, [true], 0));
