function scaled(x) = x * scale_of_scene;
module scaled_module() echo(scaled(10));
