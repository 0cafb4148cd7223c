t = [["cat", 1], ["b", 2], ["c", 3], ["dog", 4], ["a", 5], ["b", 6], ["c", 7], ["d", 8], ["e", 9], ["apple", 10], ["a", 11]];
echo(search(["b", "zzz", "a", "c", "apple", "dog"], t, num_returns_per_match = 1));
echo(search(["b", "zzz", "a", "c", "apple", "dog"], t, 1));
echo(search(["b", "zzz", "a"], t, 0), search(["b", "zzz", "a"], t, 2), search(["b"], t), search([], t));
echo(search([2, 9], [1, 2, 9, 9]), search([2, 9, 5], [1, 2, 9, 9], 0), search([3], [[1, 3], [2, 4]], 0, 1));
