t = [["a", 1], ["b", 2], ["c", 3], ["d", 4], ["a", 5], ["b", 6], ["c", 7], ["d", 8], ["e", 9]];
echo(search("a", t), search("abc", t), search("b", t, 0), search("ab", t, 0), search("ab", t, 2));
echo(search("z", t));
echo(search("az", t));
echo(search("az", t, 0));
