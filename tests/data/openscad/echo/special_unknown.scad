echo($nothing);
echo(is_undef($nothing), $nothing == undef);
