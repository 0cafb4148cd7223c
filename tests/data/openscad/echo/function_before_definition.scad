echo(late(2), value);
function late(x) = x + value;
value = 40;
