echo([undef], [undef] == [undef], len([undef, undef]), [1, undef, 3][1]);
echo([1, undef] + [1, 2], [1, undef] * 2, [1, undef] * [1, 2], -[undef]);
echo(str(undef), str([undef]), concat(undef, [undef]));
