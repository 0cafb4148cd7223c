function $f(x) = x * 2;
module $m() echo("dollar module", $children);
echo($f(3));
$m();
$1 = 5;
echo($1);
