module m() children("a");
m() echo("c");
module u() children(undef);
u() echo("undef");
module t() children(true);
t() echo("true");
