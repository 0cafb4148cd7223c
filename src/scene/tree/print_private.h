/* SPDX-License-Identifier: MIT
 * What the files that print a scene share; see print.h.
 */
#ifndef CSG_SCENE_PRINT_PRIVATE_H
#define CSG_SCENE_PRINT_PRIVATE_H

#include "scene/formula/formula_print.h"
#include "scene/scene.h"

typedef struct csg_printer {
    const csgm_scene *scene;
    csgm_text_fn *sink;
    void *user;
} csg_printer;

void csg_put(const csg_printer *out, const char *text);
/* As short as it reads back exactly. */
void csg_put_number(const csg_printer *out, double value);
void csg_put_list(const csg_printer *out, const double *values, int count);
/* `separator` name = value */
void csg_put_argument(const csg_printer *out, const char *separator, const char *name,
                      double value);
/* Two spaces a level, of very deep ones no more. */
void csg_put_indent(const csg_printer *out, size_t depth);
/* multmatrix(...), without what follows. */
void csg_put_matrix(const csg_printer *out, const csg_affine *matrix);
/* The line of a SOFT node. */
void csg_put_soft(const csg_printer *out, const csg_node *node);
/* polygon() or polyhedron(), whose last words are `end`. */
void csg_put_shape(const csg_printer *out, const csg_shape *shape, const char *end);
/* A node without children, up to the end of its line. False: out of memory. */
bool csg_put_leaf(const csg_printer *out, const csg_node *node);

#endif
