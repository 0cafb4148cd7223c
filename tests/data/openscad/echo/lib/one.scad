module which() echo("one");
function which_f() = 1;
