trueish = 1;
undefined = 2;
iffy = 3;
forx = 4;
lettuce = 5;
each_one = 6;
module_x = 7;
functional = 8;
echo(trueish, undefined, iffy, forx, lettuce, each_one, module_x, functional);
