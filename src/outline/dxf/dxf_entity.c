/* SPDX-License-Identifier: MIT
 * Lines of the DXF entities; see dxf_entity.h. Group codes are those of Autodesk's reference.
 */
#include "outline/dxf/dxf_entity.h"

#include <string.h>

#include "base/elementary.h"
#include "outline/dxf/nurbs.h"
#include "outline/svg/svg_path.h"

static const double pi = 3.14159265358979323846;

typedef struct artist {
    const csg_dxf_file *file;
    size_t index, past;
    const csg_dxf_entity *entity;
    const csg_dxf_request *request;
    double tolerance; /* before what is drawn is enlarged */
    csg_polylines *out;
    csg_outline *pen;
} artist;

static csg_vec2 point_at(const csg_dxf_entity *e, int code)
{
    return (csg_vec2){csg_dxf_get(e, code, 0), csg_dxf_get(e, code + 10, 0)};
}

static csgm_status end_line(artist *a, bool done, bool closed)
{
    return done ? csg_polylines_finish(a->out, closed) : CSGM_ERR_MEMORY;
}

static csgm_status draw_line(artist *a)
{
    bool done = csg_outline_add(a->pen, point_at(a->entity, 10)) &&
                csg_outline_add(a->pen, point_at(a->entity, 11));
    return end_line(a, done, false);
}

/* Corners 3 and 4 stand crosswise. */
static csgm_status draw_solid(artist *a)
{
    static const int order[4] = {10, 11, 13, 12};
    bool done = true;
    for (int i = 0; i < 4; i++)
        done = done && csg_outline_add(a->pen, point_at(a->entity, order[i]));
    return end_line(a, done, true);
}

static csg_vec2 on_circle(csg_vec2 center, double radius, double degrees)
{
    double angle = fmod(degrees, 360) * pi / 180;
    return (csg_vec2){center.x + radius * csg_cos(angle), center.y + radius * csg_sin(angle)};
}

/* Of an arc; 0: by the tolerance. */
static int pieces_of(const artist *a, double radius, double turns)
{
    const csg_dxf_request *request = a->request;
    if (!request->fragments)
        return 0;
    return (int)fmax(ceil(request->fragments(request->fragments_user, radius) * fabs(turns)), 1);
}

static bool draw_arc(artist *a, csg_vec2 center, double radius, double from_deg, double sweep_deg)
{
    int pieces = pieces_of(a, radius, sweep_deg / 360);
    if (pieces)
        return csg_outline_arc_in_pieces(a->pen, center, radius, from_deg, sweep_deg, pieces);
    return csg_outline_arc(a->pen, center, radius, from_deg, sweep_deg, a->tolerance);
}

static csgm_status draw_circle(artist *a, bool whole)
{
    const csg_dxf_entity *e = a->entity;
    csg_vec2 center = point_at(e, 10);
    double radius = csg_dxf_get(e, 40, 0);
    double from = whole ? 0 : fmod(csg_dxf_get(e, 50, 0), 360);
    double sweep = whole ? 360 : fmod(csg_dxf_get(e, 51, 360) - from, 360);
    if (sweep <= 0)
        sweep += 360;
    if (!(radius > 0))
        return CSGM_OK;
    bool done = whole || csg_outline_add(a->pen, on_circle(center, radius, from));
    done = done && draw_arc(a, center, radius, from, sweep);
    return end_line(a, done, whole);
}

static csgm_status draw_ellipse(artist *a)
{
    const csg_dxf_entity *e = a->entity;
    csg_vec2 center = point_at(e, 10), major = point_at(e, 11);
    double ratio = csg_dxf_get(e, 40, 1) * (csg_dxf_get(e, 230, 1) < 0 ? -1 : 1);
    csg_vec2 minor = {-major.y * ratio, major.x * ratio};
    double from = fmod(csg_dxf_get(e, 41, 0), 2 * pi), to = csg_dxf_get(e, 42, 2 * pi);
    double sweep = fmod(to - from, 2 * pi);
    bool whole = fabs(sweep) < 1e-6 || fabs(sweep) > 2 * pi - 1e-6;
    if (whole || sweep < 0)
        sweep = whole ? 2 * pi : sweep + 2 * pi;
    if (!(csg_hypot(major.x, major.y) > 0) || ratio == 0)
        return CSGM_OK;
    csg_vec2 start = {center.x + csg_cos(from) * major.x + csg_sin(from) * minor.x,
                      center.y + csg_cos(from) * major.y + csg_sin(from) * minor.y};
    int pieces = pieces_of(a, fmax(1, fabs(ratio)) * csg_hypot(major.x, major.y), sweep / (2 * pi));
    bool done = whole || csg_outline_add(a->pen, start);
    if (pieces)
        done = done && csg_svg_ellipse_in_pieces(a->pen, center, major, minor, from, sweep, pieces);
    else
        done = done && csg_svg_ellipse(a->pen, center, major, minor, from, sweep, a->tolerance);
    return end_line(a, done, whole);
}

/* ---- polylines --------------------------------------------------------------------------- */

/* From the pen's place; a bulge is the tangent of a quarter of the angle. */
static bool draw_to(artist *a, csg_vec2 from, double bulge, csg_vec2 to)
{
    double dx = to.x - from.x, dy = to.y - from.y, length = csg_hypot(dx, dy);
    if (fabs(bulge) < 1e-9 || fabs(bulge) > 1e6 || !(length > 0))
        return csg_outline_add(a->pen, to);
    double height = (1 - bulge * bulge) / (4 * bulge), sweep = 4 * csg_atan(bulge) * 180 / pi;
    csg_vec2 center = {(from.x + to.x) / 2 - dy * height, (from.y + to.y) / 2 + dx * height};
    double radius = length * (1 + bulge * bulge) / (4 * fabs(bulge));
    double start = csg_atan2(from.y - center.y, from.x - center.x) * 180 / pi;
    if (!draw_arc(a, center, radius, start, sweep))
        return false;
    a->pen->points[a->pen->point_count - 1] = to; /* the same bits as the next one begins with */
    return true;
}

typedef struct corner {
    csg_vec2 at;
    double bulge;
} corner;

typedef struct corners {
    corner first, last;
    size_t count;
    bool done;
} corners;

static void add_corner(artist *a, corners *c, corner next)
{
    if (c->count++ == 0) {
        c->first = next;
        c->done = csg_outline_add(a->pen, next.at);
    } else if (c->done) {
        c->done = draw_to(a, c->last.at, c->last.bulge, next.at);
    }
    c->last = next;
}

static csgm_status close_corners(artist *a, corners *c, bool closed)
{
    if (closed && c->count > 1 && c->done)
        c->done = draw_to(a, c->last.at, c->last.bulge, c->first.at);
    return end_line(a, c->done, closed);
}

enum { POLYLINE_CLOSED = 1, POLYLINE_MESH = 16, POLYLINE_FACES = 64, VERTEX_OF_FRAME = 16 };

static int flags_of(const csg_dxf_entity *e)
{
    double flags = csg_dxf_get(e, 70, 0);
    return flags > 0 && flags < 65536 ? (int)flags : 0;
}

static csgm_status draw_light_polyline(artist *a)
{
    corners c = {.done = true};
    corner now = {0};
    bool open = false;
    csg_dxf_pair pair;
    const char *at = a->entity->begin;
    while (csg_dxf_pair_next(&at, a->entity->end, &pair)) {
        double value = csg_dxf_number(&pair, 0);
        if (pair.code == 10) {
            if (open)
                add_corner(a, &c, now);
            now = (corner){{value, 0}, 0};
            open = true;
        } else if (pair.code == 20) {
            now.at.y = value;
        } else if (pair.code == 42) {
            now.bulge = value;
        }
    }
    if (open)
        add_corner(a, &c, now);
    return close_corners(a, &c, flags_of(a->entity) & POLYLINE_CLOSED);
}

static csgm_status draw_polyline(artist *a)
{
    corners c = {.done = true};
    int flags = flags_of(a->entity);
    if (flags & (POLYLINE_MESH | POLYLINE_FACES))
        return CSGM_OK;
    for (size_t i = a->index + 1; i < a->past; i++) {
        const csg_dxf_entity *vertex = &a->file->entities[i];
        if (!csg_dxf_text_is(vertex->kind, "VERTEX"))
            break;
        if (!(flags_of(vertex) & VERTEX_OF_FRAME))
            add_corner(a, &c, (corner){point_at(vertex, 10), csg_dxf_get(vertex, 42, 0)});
    }
    return close_corners(a, &c, flags & POLYLINE_CLOSED);
}

/* ---- splines ------------------------------------------------------------------------------- */

typedef struct spline {
    double *knots, *weights;
    csg_vec2 *points;
    size_t knot_count, weight_count, point_count;
} spline;

/* Into arrays, or counted only where these are NULL. */
static void gather_spline(const csg_dxf_entity *e, spline *s)
{
    csg_dxf_pair pair;
    const char *at = e->begin;
    s->knot_count = s->weight_count = s->point_count = 0;
    while (csg_dxf_pair_next(&at, e->end, &pair)) {
        double value = csg_dxf_number(&pair, 0);
        if (pair.code == 40 && ++s->knot_count && s->knots)
            s->knots[s->knot_count - 1] = value;
        else if (pair.code == 41 && ++s->weight_count && s->weights)
            s->weights[s->weight_count - 1] = value;
        else if (pair.code == 10 && ++s->point_count && s->points)
            s->points[s->point_count - 1] = (csg_vec2){value, 0};
        else if (pair.code == 20 && s->point_count && s->points)
            s->points[s->point_count - 1].y = value;
    }
}

static csgm_status draw_spline(artist *a)
{
    const csg_dxf_entity *e = a->entity;
    spline s = {0};
    csg_arena arena;
    csgm_status status = CSGM_OK;
    gather_spline(e, &s);
    double degree = csg_dxf_get(e, 71, 3);
    if (!(degree >= 1 && degree <= CSG_NURBS_MOST_DEGREE) || s.point_count == 0 ||
        s.knot_count != s.point_count + (size_t)degree + 1 ||
        (s.weight_count && s.weight_count != s.point_count))
        return CSGM_OK;
    csg_arena_init(&arena, a->out->memory);
    s.knots = csg_arena_calloc(&arena, s.knot_count, sizeof *s.knots);
    s.points = csg_arena_calloc(&arena, s.point_count, sizeof *s.points);
    s.weights = csg_arena_calloc(&arena, s.weight_count + 1, sizeof *s.weights);
    if (s.knots && s.points && s.weights) {
        gather_spline(e, &s);
        csg_nurbs curve = {(int)degree, s.knots, s.point_count, s.points,
                           s.weight_count ? s.weights : NULL};
        if (csg_nurbs_is_valid(&curve))
            status = end_line(a, csg_nurbs_draw(&curve, a->pen, a->tolerance), false);
    } else {
        status = CSGM_ERR_MEMORY;
    }
    csg_arena_reset(&arena);
    return status;
}

/* ---- all ---------------------------------------------------------------------------------------
 */

csgm_status csg_dxf_draw(const csg_dxf_file *file, size_t index, size_t past,
                         const csg_dxf_request *request, double stretch, csg_polylines *out,
                         bool *drawn)
{
    artist a = {.file = file,
                .index = index,
                .past = past,
                .entity = &file->entities[index],
                .request = request,
                .tolerance = request->tolerance / (stretch > 0 ? stretch : 1),
                .out = out,
                .pen = &out->pen};
    csg_dxf_text kind = a.entity->kind;
    size_t before = out->count;
    csgm_status status = CSGM_OK;
    out->pen.point_count = 0;
    if (csg_dxf_text_is(kind, "LINE"))
        status = draw_line(&a);
    else if (csg_dxf_text_is(kind, "LWPOLYLINE"))
        status = draw_light_polyline(&a);
    else if (csg_dxf_text_is(kind, "POLYLINE"))
        status = draw_polyline(&a);
    else if (csg_dxf_text_is(kind, "ARC") || csg_dxf_text_is(kind, "CIRCLE"))
        status = draw_circle(&a, csg_dxf_text_is(kind, "CIRCLE"));
    else if (csg_dxf_text_is(kind, "ELLIPSE"))
        status = draw_ellipse(&a);
    else if (csg_dxf_text_is(kind, "SPLINE"))
        status = draw_spline(&a);
    else if (csg_dxf_text_is(kind, "SOLID") || csg_dxf_text_is(kind, "TRACE"))
        status = draw_solid(&a);
    *drawn = out->count > before;
    return status;
}
