module kind(x) {
    if (is_num(x)) echo("number");
    else if (is_string(x)) echo("string");
    else if (is_list(x)) echo("list");
    else echo("other");
}
kind(1); kind("a"); kind([1]); kind(undef); kind(true);
