group() { echo("in group"); }
render() { echo("in render"); }
render(convexity = 3) echo("convexity");
union() { echo("in union"); }
difference() { echo("in difference"); cube(); }
intersection() { echo("in intersection"); cube(); }
