// Angles beside a multiple of 90 degrees, far from zero, and negative: as they are after reduction.
echo([for (d = [-4 : 4]) cos(-90 + d * 1.4210854715202004e-14) * 1e16]);
echo([for (d = [-4 : 4]) sin(-180 + d * 2.8421709430404007e-14) * 1e16]);
echo([for (d = [-4 : 4]) cos(90 + d * 1.4210854715202004e-14) * 1e16]);
echo([for (a = [-720 : 45 : 720]) [sin(a), cos(a), tan(a)]]);
echo([for (a = [-720 : 30 : 720]) [sin(a), cos(a)]]);
echo([for (a = [-359.5 : 37.25 : 720]) [sin(a) * 1e5, cos(a) * 1e5, tan(a) * 1e5]]);
echo(sin(1e15), cos(1e15), sin(-1e9 - 0.5), sin(1 / 0), cos(-1 / 0), tan(0 / 0));
echo([for (a = [-1e-20, -1e-14, -1e-10]) [sin(a) * 1e10, cos(a), tan(a) * 1e10]]);
