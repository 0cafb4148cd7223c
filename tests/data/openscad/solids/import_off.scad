difference() { import("octahedron.off"); cube(8); }
