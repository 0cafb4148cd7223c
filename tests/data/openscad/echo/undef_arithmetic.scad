echo(undef + 1, 1 + undef, undef - 1, undef * 2, 2 * undef, undef / 2, 2 / undef, undef % 2, undef ^ 2);
echo(-undef, +undef, !undef, undef[0], undef.x, undef());
