echo(nothing);
x = nothing + 1;
echo(x, [nothing], str(nothing), nothing ? 1 : 2);
