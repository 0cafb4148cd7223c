// line comment echo("no");
echo("a"); // after
/* block echo("no"); */
echo(/* inside */ "b");
/* over
   lines */ echo("c");
/**/ echo("d"); /***/
echo("// not a comment", "/* neither */");
//
