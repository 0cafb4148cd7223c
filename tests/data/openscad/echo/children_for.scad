module m() for (i = [0 : 1]) { $i = i; children(); }
m() echo($i);
module each_child() for (i = [0 : 1 : $children - 1]) children(i);
each_child();
each_child() { echo(1); echo(2); }
