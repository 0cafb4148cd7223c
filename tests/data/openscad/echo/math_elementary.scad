echo(abs(-3), abs(3), abs(-0), sign(-3), sign(0), sign(5), sqrt(16), sqrt(2), sqrt(0));
echo(exp(0), exp(1), exp(-1), exp(1000), ln(1), ln(10), ln(0), ln(-1), log(100), log(2), log(0), log(8, 2));
echo(pow(2, 3), pow(2, 0.5), pow(-2, 3), pow(0, 0), pow(-8, 1 / 3), pow(2), pow("a", 2));
echo(abs("a"), sign(undef), sqrt([4]), exp(true), ln("e"));
