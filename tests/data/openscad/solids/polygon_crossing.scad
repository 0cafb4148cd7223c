// A loop that crosses itself is filled where it winds an odd number of times.
// components: not compared, the pieces touch
linear_extrude(4) polygon([for (i = [0 : 6]) 20 * [cos(720 / 7 * i), sin(720 / 7 * i)]]);
