x = 100;
echo([for (i = 0, x = 1; i < 3; i = i + 1, x = x * 2) x], x);
echo([for (i = 0, y = i; i < 3; i = i + 1) y]);
echo([for (i = 0, p = "-"; i < 3; p = i, i = i + 1) [i, p]]);
echo([for (i = 0; i < 3; i = i + 1, z = i) is_undef(z) ? "none" : z]);
