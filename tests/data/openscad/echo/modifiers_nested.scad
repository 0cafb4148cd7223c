union() { *echo("off"); %echo("background"); #echo("shown"); }
module m() { #echo("in module"); }
%m();
translate([1, 0, 0]) #echo("child");
*union() { echo("off 1"); echo("off 2"); }
%*echo("both");
