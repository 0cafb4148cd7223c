/* SPDX-License-Identifier: MIT
 * The d attribute of SVG paths -> lines: all commands, arcs by their centre (SVG 1.1, F.6).
 */
#ifndef CSG_OUTLINE_SVG_PATH_H
#define CSG_OUTLINE_SVG_PATH_H

#include "outline/polylines.h"

/* Adds the sub-paths. As SVG asks, a path with a mistake is drawn up to it: *broken is set. A path
 * that ends where it began is closed. */
csgm_status csg_svg_path(const char *text, double tolerance, csg_polylines *out, bool *broken);

/* Numbers divided by blanks and at most one comma; *at is moved past what was read. */
bool csg_svg_number(const char **at, double *out);

/* An arc of an ellipse, drawn by the pen: center + cos t u + sin t v, after `from` radians. */
bool csg_svg_ellipse(csg_outline *pen, csg_vec2 center, csg_vec2 u, csg_vec2 v, double from,
                     double sweep, double tolerance);
bool csg_svg_ellipse_in_pieces(csg_outline *pen, csg_vec2 center, csg_vec2 u, csg_vec2 v,
                               double from, double sweep, int pieces);

#endif
