/* SPDX-License-Identifier: MIT
 * The basic shapes and paths of SVG as lines; see svg_shape.h.
 */
#include "outline/svg/svg_shape.h"

#include <string.h>

#include "base/elementary.h"
#include "outline/svg/svg_path.h"
#include "outline/svg/svg_value.h"

typedef struct shape {
    const csg_xml *xml;
    csg_polylines *lines;
    size_t broken;
    csgm_status status;
} shape;

static csg_outline *pen_of(shape *d)
{
    return &d->lines->pen;
}

static void end_outline(shape *d, bool closed)
{
    csgm_status status = csg_polylines_finish(d->lines, closed);
    if (status != CSGM_OK && d->status == CSGM_OK)
        d->status = status;
}

static void draw_to(shape *d, double x, double y)
{
    if (!csg_outline_add(pen_of(d), (csg_vec2){x, y}))
        d->status = CSGM_ERR_MEMORY;
}

static void draw_corner(shape *d, csg_vec2 center, double rx, double ry, double from,
                        double tolerance)
{
    const double quarter = 1.57079632679489661923;
    if (!csg_svg_ellipse(pen_of(d), center, (csg_vec2){rx, 0}, (csg_vec2){0, ry}, from * quarter,
                         quarter, tolerance))
        d->status = CSGM_ERR_MEMORY;
}

static void draw_rectangle(shape *d, uint32_t e, const csg_svg_viewport *p, double tolerance)
{
    const csg_xml *xml = d->xml;
    double x = csg_svg_attribute(xml, e, "x", p->width, 0);
    double y = csg_svg_attribute(xml, e, "y", p->height, 0);
    double w = csg_svg_attribute(xml, e, "width", p->width, 0);
    double h = csg_svg_attribute(xml, e, "height", p->height, 0);
    double rx = csg_svg_attribute(xml, e, "rx", p->width, -1);
    double ry = csg_svg_attribute(xml, e, "ry", p->height, -1);
    if (!(w > 0 && h > 0))
        return;
    rx = rx < 0 ? ry : rx; /* one stands for both */
    ry = ry < 0 ? rx : ry;
    rx = fmin(fmax(rx, 0), w / 2);
    ry = fmin(fmax(ry, 0), h / 2);
    if (rx > 0 && ry > 0) {
        draw_to(d, x + w, y + h - ry);
        draw_corner(d, (csg_vec2){x + w - rx, y + h - ry}, rx, ry, 0, tolerance);
        draw_to(d, x + rx, y + h);
        draw_corner(d, (csg_vec2){x + rx, y + h - ry}, rx, ry, 1, tolerance);
        draw_to(d, x, y + ry);
        draw_corner(d, (csg_vec2){x + rx, y + ry}, rx, ry, 2, tolerance);
        draw_to(d, x + w - rx, y);
        draw_corner(d, (csg_vec2){x + w - rx, y + ry}, rx, ry, 3, tolerance);
    } else {
        draw_to(d, x, y);
        draw_to(d, x + w, y);
        draw_to(d, x + w, y + h);
        draw_to(d, x, y + h);
    }
    end_outline(d, true);
}

static void draw_ellipse(shape *d, uint32_t e, const csg_svg_viewport *p, double tolerance)
{
    const csg_xml *xml = d->xml;
    csg_vec2 center = {csg_svg_attribute(xml, e, "cx", p->width, 0),
                       csg_svg_attribute(xml, e, "cy", p->height, 0)};
    double diagonal = csg_hypot(p->width, p->height) / 1.41421356237309504880;
    double r = csg_svg_attribute(xml, e, "r", diagonal, 0);
    double rx = csg_svg_attribute(xml, e, "rx", p->width, r);
    double ry = csg_svg_attribute(xml, e, "ry", p->height, r);
    if (strcmp(xml->elements[e].name, "circle") == 0)
        rx = ry = r;
    if (!(rx > 0 && ry > 0))
        return;
    for (int quarter = 0; quarter < 4; quarter++)
        draw_corner(d, center, rx, ry, quarter, tolerance);
    end_outline(d, true);
}

static void draw_line(shape *d, uint32_t e, const csg_svg_viewport *p)
{
    const csg_xml *xml = d->xml;
    draw_to(d, csg_svg_attribute(xml, e, "x1", p->width, 0),
            csg_svg_attribute(xml, e, "y1", p->height, 0));
    draw_to(d, csg_svg_attribute(xml, e, "x2", p->width, 0),
            csg_svg_attribute(xml, e, "y2", p->height, 0));
    end_outline(d, false);
}

static void draw_points(shape *d, uint32_t e, bool closed)
{
    const char *at = csg_xml_get(d->xml, e, "points");
    double x, y;
    while (at && *at && d->status == CSGM_OK && csg_svg_number(&at, &x) && csg_svg_number(&at, &y))
        draw_to(d, x, y);
    d->broken += at && *at;
    end_outline(d, closed);
}

static void draw_path(shape *d, uint32_t e, double tolerance)
{
    const char *text = csg_xml_get(d->xml, e, "d");
    bool broken = false;
    csgm_status status = text ? csg_svg_path(text, tolerance, d->lines, &broken) : CSGM_OK;
    d->broken += broken;
    if (status != CSGM_OK)
        d->status = status;
}

bool csg_svg_is_shape(const char *name)
{
    static const char *const shapes[] = {"path",    "rect",     "circle", "ellipse",
                                         "polygon", "polyline", "line"};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        if (strcmp(name, shapes[i]) == 0)
            return true;
    return false;
}

csgm_status csg_svg_shape_lines(const csg_xml *xml, uint32_t element,
                                const csg_svg_viewport *viewport, double tolerance,
                                csg_polylines *out, size_t *broken)
{
    const char *name = xml->elements[element].name;
    shape d = {.xml = xml, .lines = out};
    if (strcmp(name, "path") == 0)
        draw_path(&d, element, tolerance);
    else if (strcmp(name, "rect") == 0)
        draw_rectangle(&d, element, viewport, tolerance);
    else if (strcmp(name, "circle") == 0 || strcmp(name, "ellipse") == 0)
        draw_ellipse(&d, element, viewport, tolerance);
    else if (strcmp(name, "polygon") == 0 || strcmp(name, "polyline") == 0)
        draw_points(&d, element, strcmp(name, "polygon") == 0);
    else
        draw_line(&d, element, viewport);
    *broken += d.broken;
    return d.status;
}
