children();
children(0);
echo($children);
echo("end");
