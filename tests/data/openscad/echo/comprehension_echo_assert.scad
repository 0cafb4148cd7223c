echo([for (i = [0 : 1]) echo(i) i * 2], [for (i = [1 : 2]) assert(i > 0) i]);
echo([echo("in list") 1, 2]);
echo([for (i = [0 : 1]) let (j = i) echo("j", j) j]);
