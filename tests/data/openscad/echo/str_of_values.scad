echo(str(1, "a", true, undef, [1, "b", [2]], [0 : 2], [0 : 0.5 : 2]));
echo(str(), str(""), str("", ""), str([]), str([[]]), str([""]));
echo(str(1e6, " ", 0.1 + 0.2, " ", 1 / 3, " ", -0));
echo(str("a\"b"), str(["a\"b"]), str("a\nb"));
echo(str(str(1), str([str(2)])));
echo(len(str(123.456)), str(1) == "1");
