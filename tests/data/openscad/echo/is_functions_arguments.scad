echo(is_num(), is_string(1, 2), is_undef());
