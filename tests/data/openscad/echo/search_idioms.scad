names = ["red", "green", "blue"];
table = [["red", 1], ["green", 2], ["blue", 3]];
function find(k) = let (i = search([k], table)) i[0] == [] ? undef : table[i[0]][1];
echo(find("green"), find("pink"), search(["blue"], names)[0], search(["x"], names));
echo(len(search("l", "hello", 0)[0]), search("l", "hello", 0)[0], search("hello", "l", 0));
echo([for (m = search([1, 3], [3, 1, 3], 0)) len(m)], search(1, [0, 1, 1, 0, 1], 0), search([[0, 1]], [[0, 1], [1, 0]]));
