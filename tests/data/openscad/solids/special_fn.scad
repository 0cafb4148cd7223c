// $fn goes down into modules, and stands back where a call names its own.
module knob() { cylinder(h = 6, r = 8); translate([0, 0, 6]) cylinder(h = 8, r = 4, $fn = 100); }
$fn = 6;
knob();
translate([25, 0, 0]) knob($fn = 5);
translate([50, 0, 0]) let ($fn = 8) knob();
