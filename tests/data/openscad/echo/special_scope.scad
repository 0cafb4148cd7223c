$x = 1;
module show() echo($x);
show();
module m() { $x = 2; show(); }
m();
show();
show($x = 3);
module n() { show(); }
n($x = 4);
