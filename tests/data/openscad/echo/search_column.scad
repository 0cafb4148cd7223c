t = [[1, "x"], [2, "y"], [3, "x"]];
echo(search("x", t, 1, 1), search("x", t, 0, 1), search("y", t, 0, 0), search(["x"], t, 0, 1), search(["x", "y"], t, 1, 1));
echo(search([[1, 2]], [[1, 2], [3, 4]], 1, 0), search([1], [[[1, 2]], [[3]]]), search("x", t, 0, 5));
