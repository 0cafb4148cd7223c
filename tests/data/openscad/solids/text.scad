$fn = 40;
linear_extrude(4) text("Rag 5", size = 20);
