echo("before");
!echo("root");
echo("after");
