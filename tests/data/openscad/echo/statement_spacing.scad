module m(){echo("tight");}m();module n ( a ) echo ( a ) ;n ( 1 ) ;
for(i=[0:1])echo(i);if(true)echo("t");else echo("f");
