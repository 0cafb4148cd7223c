$sp = "library";
module show_special() echo($sp);
function get_special() = $sp;
