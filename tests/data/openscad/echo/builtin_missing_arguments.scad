echo(sin(), len(), pow(), atan2(1), norm(), cross([1, 2, 3]), lookup(1), search(1), ord(), is_num());
