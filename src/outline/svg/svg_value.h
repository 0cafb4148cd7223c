/* SPDX-License-Identifier: MIT
 * The values of SVG attributes: lengths, transforms, view boxes, and the few properties of style
 * that change a shape.
 */
#ifndef CSG_OUTLINE_SVG_VALUE_H
#define CSG_OUTLINE_SVG_VALUE_H

#include "outline/polylines.h"
#include "outline/svg/xml.h"

typedef enum csg_svg_unit { CSG_SVG_UNIT_NONE, CSG_SVG_UNIT_PX, CSG_SVG_UNIT_PERCENT } csg_svg_unit;

/* A number with a unit, in pixels of 1/96 inch unless the unit is none or percent. False: neither.
 */
bool csg_svg_length(const char *text, double *value, csg_svg_unit *unit);
/* An attribute as a length in pixels, a percentage of `whole`; `otherwise` where it is absent or
 * wrong. */
double csg_svg_attribute(const csg_xml *xml, uint32_t element, const char *name, double whole,
                         double otherwise);

/* A list of transforms. False: a mistake, *out is the identity. */
bool csg_svg_transform(const char *text, csg_affine *out);
/* a, b, c, d, e, f of SVG's matrix(). */
csg_affine csg_svg_matrix(double a, double b, double c, double d, double e, double f);

typedef struct csg_svg_view {
    double x, y, width, height; /* of the viewBox; width 0 = none */
    bool stretch, slice;        /* of preserveAspectRatio */
    double align_x, align_y;    /* 0, 0.5 or 1 */
} csg_svg_view;

csg_svg_view csg_svg_view_of(const csg_xml *xml, uint32_t element);
/* From the view box (or pixels) to a rectangle 0, 0, width, height. */
csg_affine csg_svg_view_map(const csg_svg_view *view, double width, double height);

/* What children inherit. */
typedef struct csg_svg_style {
    bool fill_none, stroke_none, even_odd;
    double stroke_width;
    csg_cap cap;
    csg_line_join join;
    double miter_limit;
} csg_svg_style;

csg_svg_style csg_svg_style_initial(void);
/* What the element's attributes and its style attribute say on top. */
void csg_svg_style_apply(const csg_xml *xml, uint32_t element, csg_svg_style *style);
/* A property that is not inherited, as display: does it have this value? */
bool csg_svg_property_is(const csg_xml *xml, uint32_t element, const char *name, const char *value);

#endif
