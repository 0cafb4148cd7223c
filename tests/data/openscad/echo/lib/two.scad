module which() echo("two");
function which_f() = 2;
