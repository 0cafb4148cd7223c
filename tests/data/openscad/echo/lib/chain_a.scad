use <chain_b.scad>
depth = 1;
function chain() = [depth, inner_chain()];
module chain_module() { echo("a", depth); inner_module(); }
