echo([each [1, 2, 3]], [each [0 : 3]], [each "abc"], [each 5], [each undef], [each [[1], [2]]], [each []]);
echo([for (i = [0 : 2]) each [i, i * 10]], [each for (i = [0 : 2]) [i, i]], [each each [[1, 2], [3]]]);
echo([0, each [1, 2], 3], [each if (true) [1, 2]], [each if (false) [1] else [2, 3]], [each let (a = 2) [a, a]]);
echo([each (true ? [1] : [2])], [each concat([1], [2])], [each true]);
