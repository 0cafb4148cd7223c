/* SPDX-License-Identifier: MIT
 * What can be asked of polygons.h: the words that it shares with its adapter in C++.
 */
#ifndef CSG_SHAPE_POLYGONS_TERMS_H
#define CSG_SHAPE_POLYGONS_TERMS_H

typedef enum csg_fill { CSG_FILL_EVEN_ODD, CSG_FILL_NONZERO } csg_fill;
typedef enum csg_polygons_op {
    CSG_POLYGONS_UNION,
    CSG_POLYGONS_INTERSECTION,
    CSG_POLYGONS_DIFFERENCE
} csg_polygons_op;
typedef enum csg_corner { CSG_CORNER_ROUND, CSG_CORNER_MITER, CSG_CORNER_CHAMFER } csg_corner;

#endif
