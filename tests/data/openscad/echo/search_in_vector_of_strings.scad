echo(search(["foo", "bar"], ["foo", "baz", "bar", "foo"]), search(["foo"], ["foo", "baz", "bar", "foo"], 0));
echo(search("f", ["foo", "far", "bar"]), search("f", [["foo"], ["f"]]));
