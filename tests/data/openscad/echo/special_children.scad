module m() { $x = 5; children(); }
m() echo($x);
module outer() { $y = 1; inner() children(); }
module inner() { $z = 2; children(); }
outer() echo($y, $z);
