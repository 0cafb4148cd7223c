echo([nope, 1, nope2]);
echo(len([nope]), [nope][0] == undef);
