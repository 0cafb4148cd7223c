// As large libraries are written: defaults, checks of arguments, small vectors and matrices, modules around
// children. csgmesh check tests/bench/library.scad
INCH = 25.4; EPS = 1e-9; UP = [0, 0, 1]; RIGHT = [1, 0, 0]; CENTER = [0, 0, 0]; FWD = [0, -1, 0];
g1 = 1; g2 = 2; g3 = 3; g4 = 4; g5 = 5; g6 = 6; g7 = 7; g8 = 8;
_NO_ARG = [true, [123232345], false];
function is_def(x) = !is_undef(x);
function default(v, dflt = undef) = is_undef(v) ? dflt : v;
function first_defined(v, recursive = false, _i = 0) = _i < len(v) && is_undef(v[_i]) ? first_defined(v, recursive, _i + 1) : v[_i];
function get_radius(r1, r2, r, d, d1, d2, dflt) = first_defined([r1, r2, r, is_def(d) ? d / 2 : undef, is_def(d1) ? d1 / 2 : undef, d2, dflt]);
function is_vector(v, length, zero, all_nonzero = false, eps = EPS) =
  is_list(v) && len(v) > 0 && [] == [for (vi = v) if (!is_num(vi)) 0] && (is_undef(length) || len(v) == length)
  && (is_undef(zero) || ((norm(v) >= eps) == !zero)) && (!all_nonzero || min([for (x = v) abs(x)]) > 0);
function unit(v, error = [[["ASSERT"]]]) = assert(is_vector(v), "bad") norm(v) < EPS ? (error == [[["ASSERT"]]] ? assert(norm(v) >= EPS) v : error) : v / norm(v);
function ident(n) = [for (i = [0 : 1 : n - 1]) [for (j = [0 : 1 : n - 1]) i == j ? 1 : 0]];
function zrot_m(a) = [[cos(a), -sin(a), 0, 0], [sin(a), cos(a), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
function apply(m, pts) = let (tm = [for (p = pts) concat(p, [1])]) [for (p = tm) let (q = m * p) [q.x, q.y, q.z]];
function cumsum(v, _i = 0, _acc = []) = _i == len(v) ? _acc : cumsum(v, _i + 1, [each _acc, _i == 0 ? v[0] : _acc[_i - 1] + v[_i]]);
function lerp(a, b, u) = assert(is_num(u)) (1 - u) * a + u * b;
function bezier(p, u) = len(p) == 1 ? p[0] : bezier([for (i = [0 : 1 : len(p) - 2]) lerp(p[i], p[i + 1], u)], u);
f = function (x, k = 3) let (a = x * k, b = a + 1) a * b;
pts = [for (i = [0 : 400]) [10 * cos(i), 10 * sin(i), i / 40]];
rot = [for (a = [0 : 5 : 355]) apply(zrot_m(a), pts)];
u = [for (r = rot) for (p = r) unit(p, UP)];
b = [for (t = [0 : 0.001 : 1]) bezier([[0, 0, 0], [10, 20, 3], [20, -5, 4], [30, 8, 2], [40, 0, 0]], t)];
echo(len(u), u[100], b[500], cumsum([for (i = [1 : 300]) i])[299], get_radius(d = 10, dflt = 1));
echo([for (i = [0 : 2000]) f(i)][77]);
module attach(anchor = CENTER, spin = 0, orient = UP, size = [1, 1, 1]) {
  $parent_size = size; $parent_anchor = anchor;
  assert(is_vector(anchor, 3)); assert(is_num(spin));
  m = ident(4); off = [for (i = [0 : 2]) -anchor[i] * size[i] / 2];
  translate(off) rotate([0, 0, spin]) multmatrix(m) children();
}
module cuboid(size = [1, 1, 1], anchor = CENTER, spin = 0) {
  sz = is_num(size) ? [size, size, size] : size;
  attach(anchor, spin, UP, sz) { cube(sz, center = true); }
}
for (i = [0 : 25], j = [0 : 25]) translate([i * 4, j * 4, 0]) cuboid(size = [2, 2, 1 + (i + j) % 5], anchor = [0, 0, -1], spin = i * 3);
