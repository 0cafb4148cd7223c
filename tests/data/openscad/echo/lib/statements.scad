echo("statement of the file");
from_statements = 11;
cube(1);
