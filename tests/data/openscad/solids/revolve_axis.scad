// A figure that touches the axis is a solid without a hole.
$fn = 120;
rotate_extrude() polygon([[0, 0], [12, 0], [3, 6], [3, 20], [9, 26], [0, 30]]);
