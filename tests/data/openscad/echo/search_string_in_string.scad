echo(search("a", "abcdabcd"), search("e", "abcdabcd"), search("a", "abcdabcd", 0), search("a", "abcdabcd", 1), search("a", "abcdabcd", 2));
echo(search("abe", "abcabcd"), search("abc", "abcabcd", 0), search("aba", "ab"), search("", "abc"), search("a", ""));
echo(search("é€", "a€é"), search("ae", "abcd", 0), search("ab", "ba", 1));
