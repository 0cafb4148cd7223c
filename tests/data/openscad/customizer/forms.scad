// plain
a = 5;
// Ten
b = 10; // [1:100]
c = 10; // [1:0.5:100]
d = 10; // [10, 20, 30]
e = "x"; // [x, y, z]
f = "S"; // [S:Small, M:Medium, L:"Large one"]
g = 1; // [1:small, 2:large]
h = "foo"; // 8
i = 3; // .5
j = [1,2,3]; // [0:0.1:10]
k = true;
/* [Section one] */
l = -4; // [-10:10]
m = 4; // [100]
n = "a b"; // [a b, c d, e-f, foo_bar:hello world]
/* [A] [B] */
p = 3; // max 7
q = 1; r = 2; // [3:4]
s = 2; // see [http://x]
t = 2;// [1:2] trailing
u = 1 + 2; // [1:5]
v = a; // [1:5]
y = 7; /* [1:9] */
z = !true;
  // indented descr
aa = 1;
// one // two
ab = 1;  //   [ 1 : 2 : 9 ]
ac = "q"; // [q:0, w:1]
ad = 3; // 1
ae = 0; // [0:No, 1:Yes]
af = -1; // [-1:neg, 1:pos, 2.5:half]
ag = "a"; // ["a", "b:c"]
ah = 5; // [ ,1,2]
ai = 5; // [1,2,]
ak = [1,2,3,4,5]; // [1:9]
/* [Hidden] */
ba = 1;
/* not a [group
*/
bc = 2;
/* [
T2] */
bd = 2;
  bf = 1; cube(a); // [1:3]
bg = "say \"hi\""; // x
$fn = 30; // [3:60]
/* [More forms] */
x_a = 1; // [1:neg, 2-x, 3x]
x_c = 1; // [-5]
x_d = 1; // [1 : 2 : 3 : 4]
x_e = 1; // [a:b:c]
x_f = 1; // [1:a b c]
x_g = 1; // ["x":"y", 3:"z"]
x_h = 1; // -5
x_j = 1; // 5 text
x_k = 1; // [1,2
x_l = 1; // []
x_m = 1; // [ ]
x_n = 1; // [a]
x_o = 1; //[0:1]
x_p = 1; ///[0:1]
x_q = "a//b"; // [0:1]
x_r = "a;b;c"; // [x,y]
x_t = 1; // [+1:3]
x_v = 1; // [[1,2],[3,4]]
x_w = "it"; // ["a\"b", x]
x_x = 1; // [0:.1:1]
x_y = 1; // [true, false]
x_z = 1; // [a,,b]
x_a1 = 1; // "text"
x_a2 = 1; // [1:5:a]
x_a3 = 1; // [1:"a b"]
x_a4 = 1; // [,a]
x_a5 = 1; // [a b:c d,e:f g]
x_a6 = 1; // [x:1, y:2]
x_a7 = 1; // [x:-1, y:2.5]
x_a8 = 1; // 10 : 20
x_a9 = 1; // [a:"q"]
bool = !true;
negative = [-1, +2]; // [-3:.5:3]
empty = ""; // 12
 module foo() { }
ca = 1; // [1:2]
