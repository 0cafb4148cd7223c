linear_extrude() square([60, 40]);
