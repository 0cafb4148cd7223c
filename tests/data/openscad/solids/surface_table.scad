surface("heights.dat");
