function boom() = assert(false, "must not run") 1;
echo(false && boom(), true || boom(), true ? 1 : boom(), false ? boom() : 2);
