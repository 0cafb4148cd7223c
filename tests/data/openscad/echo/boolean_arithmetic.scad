echo(true + 1);
echo(true * 2, -true, true / 2, true % 2);
echo(true + true, true - false, true ^ 2);
echo(true == 1, false == 0, true == true, true != 1);
echo(true < false, false < true, true <= true, true > false);
