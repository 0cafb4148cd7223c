$fn = 77;
function facet_function() = $fn;
module facets() { echo($fn); inner_facets(); }
module inner_facets() echo("inner", $fn);
