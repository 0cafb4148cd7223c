module m() { echo(parent_module(0)); children(); }
module n() { m() echo(parent_module(0), parent_module(), $parent_modules); }
n();
module k() { echo(parent_module(), parent_module("a"), parent_module(-1), parent_module(9)); }
k();
