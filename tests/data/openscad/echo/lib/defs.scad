lib_variable = "library";
function lib_function(x) = [x * 2, lib_variable];
module lib_module() { echo("lib_module", lib_variable); }
