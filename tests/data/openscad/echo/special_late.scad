echo($late);
module m() echo($late);
m();
$late = 4;
