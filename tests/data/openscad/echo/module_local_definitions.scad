module m() {
    function f(x) = x * k;
    k = 3;
    module inner() echo(f(2));
    inner();
    echo(f(5));
}
m();
k = 10;
