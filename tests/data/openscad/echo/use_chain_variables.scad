use <lib/chain_a.scad>
echo(chain());
chain_module();
