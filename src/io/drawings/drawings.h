/* SPDX-License-Identifier: MIT
 * Drawings as files: outlines of flat scenes (shape/plane/drawing.h) in millimetres.
 */
#ifndef CSG_IO_DRAWINGS_H
#define CSG_IO_DRAWINGS_H

#include "base/context.h"
#include "shape/plane/drawing.h"

csgm_drawing_format csg_drawing_format_from_path(const char *path); /* NULL gives NONE */
csgm_drawing_format csg_drawing_format_from_name(const char *name);
const char *csg_drawing_format_name(csgm_drawing_format format);

/* As csg_io_write and csg_io_write_fd (formats.h). Of the options sync, only_if_changed and unit
 * count; a scene unit is a millimetre where they say none. */
csgm_status csg_io_draw(csgm_context *context, const csg_drawing *drawing, const char *path,
                        csgm_drawing_format format, const csgm_write_options *options);
csgm_status csg_io_draw_fd(csgm_context *context, const csg_drawing *drawing, int fd,
                           const char *name, csgm_drawing_format format,
                           const csgm_write_options *options);

/* ---- what writers share --------------------------------------------------------------------- */

/* A file under construction, in memory: PDF must know where its pieces begin. */
typedef struct csg_page {
    csg_memory *memory;
    char *data;
    size_t length, capacity;
    bool failed;  /* memory ran out: later puts do nothing */
    double scale; /* from scene units to millimetres */
    int decimals; /* of coordinates in millimetres: to about 1e-9 of the drawing's size */
    csg_box box;  /* of the drawing in millimetres */
} csg_page;

typedef void csg_draw_fn(csg_page *page, const csg_drawing *drawing);
#define CSG_DRAWING(ID, name, title, remarks) csg_draw_fn csg_draw_##name;
#include "io/drawings/drawings.def"
#undef CSG_DRAWING

void csg_page_bytes(csg_page *page, const void *bytes, size_t count);
void csg_page_text(csg_page *page, const char *text);
void csg_page_format(csg_page *page, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Without an exponent, as short as the decimals allow, in no locale. */
void csg_page_number(csg_page *page, double value, int decimals);
/* SVG 1.1 up to the first element, with the page's box as its view. namespaces: more of them, each
 * after a space. */
void csg_page_begin_svg(csg_page *page, const char *namespaces);
/* A point of a path in scene units, after a letter. y points down there. */
void csg_page_svg_point(csg_page *page, const char *letter, csg_vec2 point);
/* What people call the layer: its part's name, its colour "#rrggbb", or "outline". */
const char *csg_layer_label(const csg_drawn_layer *layer, char buffer[8]);

#endif
