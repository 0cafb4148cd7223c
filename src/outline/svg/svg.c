/* SPDX-License-Identifier: MIT
 * The walk through an SVG document; see svg.h. Elements are drawn one by one: its lines, in its own
 * coordinates, then the map to the page, then the clean area of this one shape.
 */
#include "outline/svg/svg.h"

#include <string.h>

#include "base/elementary.h"
#include "base/table.h"
#include "outline/svg/svg_shape.h"
#include "outline/svg/svg_value.h"
#include "shape/plane/polygons.h"

enum {
    MOST_DEPTH = 400,       /* of elements and uses */
    MOST_VISITS = 4 << 20,  /* of elements and their bytes, each time one is used anew */
    USED_SHAPE_VISITS = 16, /* a use takes few bytes, its shape much time */
    MOST_USES = 32,         /* within each other */
    MOST_SHAPE_POINTS = 1 << 20
};

typedef struct drawing {
    const csg_svg_request *request;
    csg_svg_report *report;
    csg_outline *out;
    csg_xml xml;
    csg_polylines lines; /* of the shape at work */
    csg_outline loops;   /* its area, before it is clean */
    csg_table ids;       /* elements */
    size_t visits, depth;
    uint32_t used[MOST_USES]; /* the targets of the uses that are being drawn */
    size_t used_count;
    csgm_status status;
} drawing;

/* Handed from an element to its children. */
typedef struct place {
    csg_affine map; /* to mm */
    csg_svg_style style;
    csg_svg_viewport viewport;
    bool chosen; /* by id and layer */
} place;

static void draw_element(drawing *d, uint32_t element, const place *outer);

static csgm_status out_of_memory(drawing *d)
{
    return d->status = CSGM_ERR_MEMORY;
}

/* ---- from lines to areas ---------------------------------------------------------------- */

/* Open lines become strokes before the map, so that an uneven one makes uneven strokes. */
static bool add_stroke(drawing *d, const csg_polyline *line, const csg_svg_style *style,
                       double tolerance)
{
    csg_stroke stroke = {.width = style->stroke_width > 0 ? style->stroke_width : 1,
                         .cap = style->cap,
                         .join = style->join,
                         .miter_limit = style->miter_limit,
                         .tolerance = tolerance};
    return csg_stroke_line(&stroke, d->lines.points + line->first, line->count, &d->loops);
}

static bool add_area(drawing *d, const csg_polyline *line)
{
    for (size_t i = 0; i < line->count; i++)
        if (!csg_outline_add(&d->loops, d->lines.points[line->first + i]))
            return false;
    return csg_outline_close(&d->loops);
}

static bool is_bounded(const csg_outline *loops)
{
    for (size_t i = 0; i < loops->point_count; i++)
        if (!(fabs(loops->points[i].x) <= CSG_INPUT_MOST_COORDINATE &&
              fabs(loops->points[i].y) <= CSG_INPUT_MOST_COORDINATE))
            return false;
    return true;
}

/* The loops at work, cleaned by their rule, go to the result. */
static void add_clean(drawing *d, const csg_affine *map, csg_fill fill)
{
    csg_outline clean;
    if (d->status != CSGM_OK || d->loops.loop_count == 0)
        return;
    if (d->loops.point_count > MOST_SHAPE_POINTS || d->out->point_count > CSG_INPUT_MOST_POINTS) {
        d->status = CSGM_ERR_LIMIT;
        return;
    }
    csg_outline_transform(&d->loops, map);
    if (!is_bounded(&d->loops)) {
        d->status =
            csg_problem_set(&d->report->problem, CSGM_ERR_FORMAT, "it has coordinates beyond 1e15");
        return;
    }
    d->status = csg_polygons_clean(&d->loops, fill, &clean);
    if (d->status == CSGM_ERR_LIMIT)
        csg_problem_set(&d->report->problem, d->status,
                        "a path crosses or covers itself too often");
    if (d->status == CSGM_OK && !csg_outline_append(d->out, &clean))
        out_of_memory(d);
    csg_outline_release(&clean);
    d->loops.point_count = d->loops.loop_count = 0;
}

static void add_lines(drawing *d, const place *p, double tolerance)
{
    bool fills = p->style.stroke_none && !p->style.fill_none;
    bool done = true;
    for (size_t i = 0; i < d->lines.count && done; i++)
        if (d->lines.items[i].closed || fills)
            done = add_area(d, &d->lines.items[i]);
    add_clean(d, &p->map, p->style.even_odd ? CSG_FILL_EVEN_ODD : CSG_FILL_NONZERO);
    for (size_t i = 0; i < d->lines.count && done && d->status == CSGM_OK; i++)
        if (!d->lines.items[i].closed && !fills)
            done = add_stroke(d, &d->lines.items[i], &p->style, tolerance);
    add_clean(d, &p->map, CSG_FILL_NONZERO);
    if (!done)
        out_of_memory(d);
}

static void draw_shape(drawing *d, uint32_t e, const place *p)
{
    const double(*m)[3] = p->map.m;
    double stretch =
        csg_hypot(csg_hypot(m[0][0], m[0][1]), csg_hypot(m[1][0], m[1][1])); /* at least */
    double tolerance = d->request->tolerance / (stretch > 0 ? stretch : 1);
    csg_polylines_clear(&d->lines);
    d->visits += d->used_count ? USED_SHAPE_VISITS : 0;
    d->status =
        csg_svg_shape_lines(&d->xml, e, &p->viewport, tolerance, &d->lines, &d->report->broken);
    if (d->status == CSGM_OK && d->lines.count) {
        d->report->shapes++;
        add_lines(d, p, tolerance);
    }
}

/* ---- containers -------------------------------------------------------------------------- */

static void draw_children(drawing *d, uint32_t e, const place *p)
{
    for (uint32_t child = d->xml.elements[e].first_child;
         child != CSG_XML_NONE && d->status == CSGM_OK; child = d->xml.elements[child].next_sibling)
        draw_element(d, child, p);
}

static void move_by(place *p, const csg_affine *map)
{
    p->map = csg_affine_multiply(p->map, *map);
}

/* svg inside svg, and symbol where it is used. */
static void draw_viewport(drawing *d, uint32_t e, const place *p, double width, double height)
{
    csg_svg_view view = csg_svg_view_of(&d->xml, e);
    csg_affine map = csg_svg_view_map(&view, width, height);
    place inner = *p;
    move_by(&inner, &map);
    inner.viewport.width = view.width > 0 ? view.width : width;
    inner.viewport.height = view.height > 0 ? view.height : height;
    draw_children(d, e, &inner);
}

/* The element of this id, or CSG_TABLE_NONE and the slot to put one at. */
static uint32_t find_id(const drawing *d, const char *id, size_t *slot)
{
    uint64_t hash = csg_hash_bytes(CSG_HASH_START, id, strlen(id));
    uint32_t e = csg_table_first(&d->ids, hash, slot);
    while (e != CSG_TABLE_NONE && strcmp(csg_xml_get(&d->xml, e, "id"), id) != 0)
        e = csg_table_next(&d->ids, slot);
    return e;
}

/* Elements by their ids; of equal ids the first counts. */
static bool make_ids(drawing *d)
{
    csg_table_init(&d->ids, d->xml.memory);
    if (!csg_table_reserve(&d->ids, d->xml.count, NULL, NULL))
        return false;
    for (uint32_t e = 0; e < d->xml.count; e++) {
        size_t slot;
        const char *id = csg_xml_get(&d->xml, e, "id");
        if (id && find_id(d, id, &slot) == CSG_TABLE_NONE)
            csg_table_put(&d->ids, slot, e);
    }
    return true;
}

/* Inside itself, or too deep in others. */
static bool is_in_use(const drawing *d, uint32_t target, uint32_t use)
{
    if (d->used_count == MOST_USES)
        return true;
    for (size_t i = 0; i < d->used_count; i++)
        if (d->used[i] == target)
            return true;
    for (; use != CSG_XML_NONE; use = d->xml.elements[use].parent)
        if (use == target)
            return true;
    return false;
}

static void draw_use(drawing *d, uint32_t e, const place *p)
{
    const csg_xml *xml = &d->xml;
    const char *href = csg_xml_get(xml, e, "href");
    size_t slot;
    uint32_t target = href && *href == '#' ? find_id(d, href + 1, &slot) : CSG_TABLE_NONE;
    if (target == CSG_TABLE_NONE || is_in_use(d, target, e)) {
        d->report->unresolved++;
        return;
    }
    d->used[d->used_count++] = target;
    csg_affine shift = csg_affine_translate(
        csg_vec3_make(csg_svg_attribute(xml, e, "x", p->viewport.width, 0),
                      csg_svg_attribute(xml, e, "y", p->viewport.height, 0), 0));
    place inner = *p;
    move_by(&inner, &shift);
    if (strcmp(xml->elements[target].name, "symbol") == 0) {
        csg_svg_style_apply(xml, target, &inner.style);
        draw_viewport(d, target, &inner,
                      csg_svg_attribute(xml, e, "width", p->viewport.width, p->viewport.width),
                      csg_svg_attribute(xml, e, "height", p->viewport.height, p->viewport.height));
    } else {
        draw_element(d, target, &inner);
    }
    d->used_count--;
}

static void draw_inner_svg(drawing *d, uint32_t e, const place *p)
{
    const csg_xml *xml = &d->xml;
    place inner = *p;
    csg_affine shift = csg_affine_translate(
        csg_vec3_make(csg_svg_attribute(xml, e, "x", p->viewport.width, 0),
                      csg_svg_attribute(xml, e, "y", p->viewport.height, 0), 0));
    move_by(&inner, &shift);
    draw_viewport(d, e, &inner,
                  csg_svg_attribute(xml, e, "width", p->viewport.width, p->viewport.width),
                  csg_svg_attribute(xml, e, "height", p->viewport.height, p->viewport.height));
}

static bool is_one_of(const char *name, const char *const *names)
{
    for (; *names; names++)
        if (strcmp(name, *names) == 0)
            return true;
    return false;
}

static void draw_container(drawing *d, uint32_t e, const place *p)
{
    static const char *const groups[] = {"g", "a", "switch", NULL};
    static const char *const unseen[] = {"defs",     "symbol",         "clipPath",       "mask",
                                         "pattern",  "marker",         "title",          "desc",
                                         "metadata", "linearGradient", "radialGradient", "filter",
                                         "script",   "view",           "cursor",         NULL};
    const char *name = d->xml.elements[e].name;
    if (is_one_of(name, groups))
        draw_children(d, e, p);
    else if (strcmp(name, "svg") == 0)
        draw_inner_svg(d, e, p);
    else if (strcmp(name, "use") == 0)
        draw_use(d, e, p);
    else if (strcmp(name, "text") == 0)
        d->report->texts++;
    else if (strcmp(name, "image") == 0 || strcmp(name, "foreignObject") == 0)
        d->report->images++;
    else if (strcmp(name, "style") == 0)
        d->report->sheets++;
    else if (!is_one_of(name, unseen) && !strchr(name, ':'))
        d->report->unknown++;
}

/* ---- elements ------------------------------------------------------------------------------ */

static bool is_attribute(const drawing *d, uint32_t e, const char *name, const char *value)
{
    const char *own = csg_xml_get(&d->xml, e, name);
    return own && strcmp(own, value) == 0;
}

static bool is_chosen(const drawing *d, uint32_t e)
{
    const csg_svg_request *q = d->request;
    if (q->id && *q->id)
        return is_attribute(d, e, "id", q->id);
    return strcmp(d->xml.elements[e].name, "g") == 0 &&
           (is_attribute(d, e, "inkscape:label", q->layer) || is_attribute(d, e, "id", q->layer));
}

static void draw_inside(drawing *d, uint32_t element, const place *outer)
{
    place p = *outer;
    csg_affine map;
    const char *transform = csg_xml_get(&d->xml, element, "transform");
    if (!p.chosen && is_chosen(d, element)) {
        p.chosen = true;
        d->report->not_found = false;
    }
    if (csg_svg_property_is(&d->xml, element, "display", "none"))
        return;
    if (transform) {
        d->report->broken += !csg_svg_transform(transform, &map);
        move_by(&p, &map);
    }
    csg_svg_style_apply(&d->xml, element, &p.style);
    if (csg_xml_get(&d->xml, element, "clip-path") || csg_xml_get(&d->xml, element, "mask"))
        d->report->clips++;
    if (!csg_svg_is_shape(d->xml.elements[element].name))
        draw_container(d, element, &p);
    else if (p.chosen)
        draw_shape(d, element, &p);
}

static void draw_element(drawing *d, uint32_t element, const place *outer)
{
    if (d->depth >= MOST_DEPTH) {
        d->report->unresolved++;
        return;
    }
    d->visits += 1 + d->xml.elements[element].bytes / 64;
    if (d->visits > MOST_VISITS) {
        d->status = csg_problem_set(&d->report->problem, CSGM_ERR_LIMIT,
                                    "its elements use each other too often");
        return;
    }
    d->depth++;
    draw_inside(d, element, outer);
    d->depth--;
}

/* ---- the page -------------------------------------------------------------------------------- */

/* A side of the page in mm; `view` is the side of the view box, 0 = none. */
static double side(const drawing *d, const char *name, double view)
{
    double dpi = d->request->dpi > 0 ? d->request->dpi : 72, value;
    csg_svg_unit unit;
    const char *text = csg_xml_get(&d->xml, 0, name);
    if (!text || !csg_svg_length(text, &value, &unit))
        return view * 25.4 / dpi;
    if (unit == CSG_SVG_UNIT_PERCENT) /* as OpenSCAD: a unit of the view box is a mm */
        return view;
    return value * 25.4 / (unit == CSG_SVG_UNIT_NONE ? dpi : 96);
}

static void draw_document(drawing *d)
{
    csg_svg_view view = csg_svg_view_of(&d->xml, 0);
    double width = side(d, "width", view.width), height = side(d, "height", view.height);
    place page = {.style = csg_svg_style_initial(), .viewport = {view.width, view.height}};
    if (view.width <= 0) {
        page.viewport.width = width;
        page.viewport.height = height;
    }
    csg_affine flip = csg_svg_matrix(1, 0, 0, -1, 0, height);
    page.map = csg_affine_multiply(flip, csg_svg_view_map(&view, width, height));
    page.chosen =
        !(d->request->id && *d->request->id) && !(d->request->layer && *d->request->layer);
    d->report->not_found = !page.chosen;
    csg_svg_style_apply(&d->xml, 0, &page.style);
    if (!page.chosen && is_chosen(d, 0)) {
        page.chosen = true;
        d->report->not_found = false;
    }
    draw_children(d, 0, &page);
}

static void center_box(csg_outline *out)
{
    csg_box box = csg_outline_box(out);
    if (out->point_count) {
        csg_affine map = csg_affine_translate(csg_vec3_scale(csg_box_center(box), -1));
        csg_outline_transform(out, &map);
    }
}

static csgm_status draw_all(drawing *d, csg_memory *memory)
{
    if (strcmp(d->xml.elements[0].name, "svg") != 0)
        return csg_problem_set(&d->report->problem, CSGM_ERR_FORMAT,
                               "it is XML but no SVG: its root element is not svg");
    csg_polylines_init(&d->lines, memory);
    csg_outline_init(&d->loops, memory);
    if (make_ids(d))
        draw_document(d);
    else
        out_of_memory(d);
    csg_table_release(&d->ids);
    csg_polylines_release(&d->lines);
    csg_outline_release(&d->loops);
    if (d->status == CSGM_ERR_LIMIT)
        csg_problem_set(&d->report->problem, d->status, "its shapes have too many points");
    return d->status;
}

csgm_status csg_svg_outline(csg_memory *memory, const csg_svg_request *request, csg_outline *out,
                            csg_svg_report *report)
{
    drawing d = {.request = request, .report = report, .out = out};
    *report = (csg_svg_report){0};
    csg_outline_init(out, memory);
    csgm_status status =
        csg_xml_parse(memory, request->text, request->length, &d.xml, &report->problem);
    if (status != CSGM_OK)
        return status;
    status = draw_all(&d, memory);
    csg_xml_release(&d.xml);
    if (status == CSGM_ERR_UNSUPPORTED)
        csg_problem_set(&report->problem, status,
                        "this build cannot read SVG files (made without Clipper)");
    if (status != CSGM_OK)
        csg_outline_release(out);
    else if (request->center)
        center_box(out);
    return status;
}
