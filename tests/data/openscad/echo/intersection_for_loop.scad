intersection_for (i = [0 : 2]) { echo(i); cube(i + 1); }
intersection_for (i = [0 : 1], j = [0 : 1]) { echo(i, j); cube(1); }
intersection_for (i = []) echo("never");
