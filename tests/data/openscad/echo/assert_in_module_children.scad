module m() { assert($children > 0, "needs children"); children(); }
m() echo("ok");
m();
echo("after");
