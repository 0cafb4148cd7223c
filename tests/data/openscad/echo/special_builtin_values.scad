echo($fn, $fa, $fs, $t);
module m() echo($fn, $fa, $fs);
m($fn = 20);
sphere($fn = 5);
$fn = 7;
m();
echo($fn);
