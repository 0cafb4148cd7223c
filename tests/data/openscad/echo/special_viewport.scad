echo($vpr, $vpt, $vpd, $vpf);
