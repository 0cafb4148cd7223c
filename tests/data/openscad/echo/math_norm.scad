echo(norm([3, 4]), norm([1, 2, 3]), norm([]), norm([5]), norm([1, 1, 1, 1]), norm([-3]));
echo(norm(5));
echo(norm([1, "a"]));
echo(norm("a"), norm(undef), norm([[1]]), norm(), norm([1], [2]));
