depth = 2;
function inner_chain() = depth;
module inner_module() echo("b", depth);
