function f(x) = x * 2;
function g(x, y = 3, z = f(2)) = [x, y, z];
function h() = "h";
echo(f(2), g(1), g(1, 2), g(1, z = 0), g(y = 1, x = 2), h(), g(z = 5, 1), h(1));
echo(f(x = 4), f(y = 4), f(1, 2));
