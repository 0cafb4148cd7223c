module show() echo($i);
for ($i = [0 : 2]) show();
let ($i = 9) show();
