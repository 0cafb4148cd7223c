echo([0 : "a"]);
echo([undef : 5], ["a" : "c"], [0 : undef : 5], [true : 5]);
for (i = [0 : undef]) echo("never", i);
echo([for (i = [0 : "x"]) i]);
echo([0 / 0 : 5], [0 : 1 / 0]);
