difference() { cube(12); %translate([0, 0, 20]) cube(12); translate([3, 3, -1]) cube([6, 6, 20]); }
%cube([50, 50, 1]);
