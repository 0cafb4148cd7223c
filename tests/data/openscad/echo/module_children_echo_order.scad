module wrap() { echo("begin"); children(); echo("end"); }
wrap() { echo("1"); wrap() echo("2"); echo("3"); }
