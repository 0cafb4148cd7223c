union() {
    include <lib/inner.scad>
    echo("block");
}
