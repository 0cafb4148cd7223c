module a() echo("a");
module b() { }
module c() if (true) echo("c");
module d() for (i = [0 : 1]) echo("d", i);
module e();
a(); b(); c(); d(); e();
