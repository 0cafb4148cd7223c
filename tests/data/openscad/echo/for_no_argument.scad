for () echo("once");
for (i = [0 : 1]);
for (i = [0 : 1]) { }
echo("end");
