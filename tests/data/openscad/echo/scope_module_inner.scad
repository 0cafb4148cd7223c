module outer(a) {
    module inner(b) { echo(a, b, c); }
    function f(x) = x + a;
    c = 3;
    inner(2);
    echo(f(10));
}
outer(1);
outer(100);
