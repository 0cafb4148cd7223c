echo("inner file"); inner_value = 3;
