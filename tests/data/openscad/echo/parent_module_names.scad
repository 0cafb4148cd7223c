module top() { mid(); }
module mid() { bottom(); }
module bottom() { echo(parent_module(0), parent_module(1), parent_module(2), $parent_modules); }
top();
bottom();
