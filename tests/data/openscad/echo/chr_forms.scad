echo(chr(65), chr(65, 66, 67), chr([72, 101, 108, 108, 111]), chr([65 : 70]));
echo(chr(), chr([]), chr(65.9), chr(-1), chr(0), chr(1114111), chr(1114112), chr(55296));
echo(chr("a"), chr(undef), chr(true), chr([65, "b", 67]), chr([[65]]));
echo(chr([90 : -1 : 85]), chr([65 : 2 : 70]), chr([70 : 65]), chr([[65, [66]], 67]));
echo(len(chr(8364)), chr(10) == "\n", chr(1e10), chr(0 / 0), chr(1 / 0));
