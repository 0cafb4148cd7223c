import("block.stl");
