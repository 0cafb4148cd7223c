echo(!0, !1, !-1, !0.5, !"", !"0", !"false", ![], ![0], ![[]], !undef, !true, !false);
echo(![0 : 0], ![1 : 0], !(function(x) x), !(1 / 0));
for (v = [0, 1, "", "a", undef, true, false]) echo(v, v ? "yes" : "no");
