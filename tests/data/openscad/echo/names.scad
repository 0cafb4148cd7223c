// Where names are found: frames of calls, lets, loops and modules, one in the other.
x = 1;
function outer(x) = let (y = x + 1, x = x * 10) [x, y, inner(x)];
function inner(z) = [x, z];
echo(outer(3));
echo(let (x = x + 1, x = x * 2) x);

// a loop's `next` hides what `first` has, from its second round on; in a loop within a loop, too
echo([for (a = 1, b = 10; a < 4; a = a + 1) [a, b]]);
echo([for (a = 0, q = 5; a < 3; a = a + 1, q = q * 2) each [for (k = 0; k < 2; k = k + 1) [a, q, k]]]);
echo([for (a = 0; a < 2; a = a + 1, c = a) [for (b = 0; b < 2; b = b + 1) [a, b, x]]]);
echo([for (a = 0, x = 7; a < 2; a = a + 1) [for (b = 0; b < 2; b = b + 1, x = 9) x]]);

// the same text from several frames
function twice(f, v) = f(f(v));
k = 3;
add = function (v) v + k;
echo(twice(add, 1), let (k = 100) twice(add, 1), let (k = 100) twice(function (v) v + k, 1));
function maker(k) = function (v) [k, v, x];
fs = [for (k = [10, 20]) maker(k)];
echo([for (f = fs) f(x)]);
function count(n, seen = []) = n == 0 ? seen : count(n - 1, [each seen, n + x]);
echo(count(4));

// a function in a variable goes before one with a name, where there is one
function pick(v) = ["named", v];
function call(pick) = pick(2);
echo(pick(1), call(function (v) ["given", v]));
function maybe(pick) = pick(3);
echo([for (p = [function (v) v, function (v) -v]) maybe(p)]);

// what is assigned later is not there yet
early = is_undef(late) ? "not yet" : late;
late = 4;
echo(early, late);

module scope(n) {
  x = n;
  function local(v) = [v, x, n];
  module deeper(m) {
    y = x + m;
    echo(local(y), x, y);
    if (m > 0) {
      x = 50;
      echo(x, y, local(x));
      deeper(m - 1);
    }
    children();
  }
  deeper(1) children();
}
scope(5) echo(x);
scope(6) { x = 8; echo(x); scope(7) echo(x); }
for (x = [2, 3], y = [x, x + 1]) echo(x, y, inner(y));
let (x = 20, y = x) echo(x, y, inner(0));

// $variables go by calls, not by places
function dynamic() = $d;
module show() echo($d, dynamic());
module with($d = 4) { show(); children(); }
$d = 1;
show();
with() show();
with($d = 5) echo($d, dynamic());
echo(let ($d = 6) dynamic());
module family() { echo($children); if ($children > 1) family() children(0); }
family() { cube(1); cube(2); }
