use <lib/facets.scad>
facets();
facets($fn = 9);
$fn = 30;
facets();
echo(facet_function());
