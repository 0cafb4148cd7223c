table = [for (i = [0 : 4]) i * base];
base = 3;
function pick(i) = i < len(table) ? table[i] : last;
last = str("only ", len(table));
