function rz(a) = [[cos(a), -sin(a), 0], [sin(a), cos(a), 0], [0, 0, 1]];
echo(rz(90), rz(30) * rz(60), rz(45) * [1, 0, 0]);
function unit(v) = v / norm(v);
echo(unit([3, 4]), unit([1, 1, 1]), unit([0, 0]));
