echo(version(), version_num());
echo(version(5), version_num(version()));
echo(version_num([2015, 3, 2]), version_num([2019, 5]), version_num("a"));
