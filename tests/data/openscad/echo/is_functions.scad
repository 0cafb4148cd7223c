vals = [undef, 1, 0 / 0, 1 / 0, true, false, "", "a", [], [1], [0 : 1], function(x) x];
for (v = vals) echo(is_undef(v), is_num(v), is_bool(v), is_string(v), is_list(v), is_function(v));
