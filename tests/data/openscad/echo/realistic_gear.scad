teeth = 12; pitch = 5;
function pitch_radius(t = teeth, p = pitch) = t * p / 360 * 180 / PI;
function tooth(i, n = teeth) = let (a = 360 / n * i, r = pitch_radius()) [r * cos(a), r * sin(a)];
echo(pitch_radius(), [for (i = [0 : teeth - 1]) tooth(i)]);
