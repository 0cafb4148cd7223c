echo(str("v=", [1, [2, "three", [true, undef]]], ";"));
echo(str([0 : 1], " ", [[0 : 1]], " ", function(x) x));
echo(str("unicode ", "é", ["é"]), str("\t|\n|"));
