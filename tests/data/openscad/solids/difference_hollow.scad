// A closed cavity is a component of the surface.
difference() { cube(20, center = true); cube(12, center = true); }
