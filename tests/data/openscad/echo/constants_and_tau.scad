echo(PI, 2 * PI, PI / 180, PI * 1e6, sin(PI), cos(180 / PI));
function deg(r) = r * 180 / PI;
echo(deg(PI), deg(PI / 2), deg(1));
