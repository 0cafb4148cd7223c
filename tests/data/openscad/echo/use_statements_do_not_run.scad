use <lib/statements.scad>
echo(is_undef(from_statements));
