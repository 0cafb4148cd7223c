x /* a */ = /* b */ 1 /* c */ ; // d
echo(x /* e */ , /* f */ 2); /* g */ echo("h"); // echo("i");
module /* j */ m /* k */ ( /* l */ ) /* m */ { /* n */ echo("m"); }
m /* o */ ();
