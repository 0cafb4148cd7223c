$fn = 200;
linear_extrude(4)
  difference() {
    union() { circle(18); intersection() { square(60, center = true); rotate(30) square([80, 10], center = true); } }
    for (a = [0 : 60 : 300]) rotate(a) translate([11, 0]) circle(3);
    intersection() { circle(6); translate([2, 0]) circle(6); }
  }
