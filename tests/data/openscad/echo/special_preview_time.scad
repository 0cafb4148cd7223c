echo($t, is_bool($preview), is_num($fn), len($vpr), len($vpt), is_num($vpd), is_num($vpf));
