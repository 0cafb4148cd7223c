use <circle_b.scad>
start = 10;
function down(n) = n > 0 ? step(n - 1) : start;
