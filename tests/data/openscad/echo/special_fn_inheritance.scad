module show() echo($fn, $fa, $fs);
module m() { $fn = 12; show(); children(); }
m($fa = 5) show();
$fs = 0.5;
show($fn = 3);
for ($fn = [4, 5]) show();
function segments() = $fn > 0 ? $fn : ceil(max(min(360 / $fa, 10 * 2 * PI / $fs), 5));
echo(segments(), segments($fn = 8));
