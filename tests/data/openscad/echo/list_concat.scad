echo(concat(), concat([]), concat([1], [2]), concat([1, 2], [], [3]), concat(1, 2), concat([1], 2, "c"), concat([[1]], [[2]]));
echo(concat("ab", "cd"), concat(undef), concat([0 : 2]), concat([1], [0 : 2]), concat(true, [false]));
