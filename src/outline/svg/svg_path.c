/* SPDX-License-Identifier: MIT
 * Path data of SVG; see svg_path.h.
 */
#include "outline/svg/svg_path.h"

#include <string.h>

#include "base/elementary.h"

static const double pi = 3.14159265358979323846;

typedef struct path {
    const char *at;
    csg_polylines *out;
    double tolerance;
    csg_vec2 start, now;
    csg_vec2 control; /* of the curve before, for S and T; else `now` */
    char before;      /* its command in upper case */
    bool drawing;     /* the pen has the point `now` */
    csgm_status status;
} path;

static void skip_blanks(const char **at)
{
    while (csg_is_blank(**at))
        ++*at;
}

static void skip_comma(const char **at)
{
    skip_blanks(at);
    if (**at == ',') {
        ++*at;
        skip_blanks(at);
    }
}

bool csg_svg_number(const char **at, double *out)
{
    skip_blanks(at);
    if (!csg_number_scan(at, *at + strnlen(*at, 600), out) ||
        fabs(*out) > CSG_INPUT_MOST_COORDINATE)
        return false;
    skip_comma(at);
    return true;
}

/* A 0 or 1 that needs no blank after it. */
static bool read_flag(const char **at, bool *out)
{
    skip_blanks(at);
    if (**at != '0' && **at != '1')
        return false;
    *out = **at == '1';
    ++*at;
    skip_comma(at);
    return true;
}

bool csg_svg_ellipse(csg_outline *pen, csg_vec2 center, csg_vec2 u, csg_vec2 v, double from,
                     double sweep, double tolerance)
{
    double radius = csg_hypot(csg_hypot(u.x, u.y), csg_hypot(v.x, v.y));
    double step =
        2 * csg_acos(1 - fmin(fmax(tolerance / radius, 1e-7), 0.29)); /* 0.29: quarter turns */
    int pieces = (int)fmin(fmax(ceil(fabs(sweep) / step), 1), 4096);
    return csg_svg_ellipse_in_pieces(pen, center, u, v, from, sweep, pieces);
}

bool csg_svg_ellipse_in_pieces(csg_outline *pen, csg_vec2 center, csg_vec2 u, csg_vec2 v,
                               double from, double sweep, int pieces)
{
    for (int i = 1; i <= pieces; i++) {
        double t = from + sweep * i / pieces, c = csg_cos(t), s = csg_sin(t);
        if (!csg_outline_add(
                pen, (csg_vec2){center.x + c * u.x + s * v.x, center.y + c * u.y + s * v.y}))
            return false;
    }
    return true;
}

static void failed(path *p, bool done)
{
    if (!done && p->status == CSGM_OK)
        p->status = CSGM_ERR_MEMORY;
}

/* Puts the pen down where the path is. */
static csg_outline *pen_of(path *p)
{
    csg_outline *pen = &p->out->pen;
    if (!p->drawing)
        failed(p, csg_outline_add(pen, p->now));
    p->drawing = true;
    return pen;
}

static void end_subpath(path *p, bool closed)
{
    if (p->drawing && p->status == CSGM_OK) {
        bool ends_at_start = p->now.x == p->start.x && p->now.y == p->start.y;
        p->status = csg_polylines_finish(p->out, closed || ends_at_start);
    }
    p->drawing = false;
}

static double angle_between(double ux, double uy, double vx, double vy)
{
    return csg_atan2(ux * vy - uy * vx, ux * vx + uy * vy);
}

/* SVG 1.1, F.6.5 and F.6.6. */
static void draw_arc(path *p, double rx, double ry, double turn_deg, bool large, bool sweep,
                     csg_vec2 to)
{
    csg_outline *pen = pen_of(p);
    double turn = fmod(turn_deg, 360) * pi / 180, c = csg_cos(turn), s = csg_sin(turn);
    double dx = (p->now.x - to.x) / 2, dy = (p->now.y - to.y) / 2;
    rx = fabs(rx), ry = fabs(ry);
    if (rx > 0 && ry > 0 && (dx != 0 || dy != 0)) {
        double x = (c * dx + s * dy) / rx, y = (c * dy - s * dx) / ry, length = x * x + y * y;
        if (length > 1) {
            rx *= sqrt(length), ry *= sqrt(length);
            x /= sqrt(length), y /= sqrt(length);
            length = 1;
        }
        double height = sqrt(fmax(1 / length - 1, 0)) * (large == sweep ? -1 : 1);
        double cx = height * y, cy = -height * x; /* of the unit circle */
        csg_vec2 u = {c * rx, s * rx}, v = {-s * ry, c * ry};
        csg_vec2 center = {(p->now.x + to.x) / 2 + cx * u.x + cy * v.x,
                           (p->now.y + to.y) / 2 + cx * u.y + cy * v.y};
        double from = csg_atan2(y - cy, x - cx);
        double angle = angle_between(x - cx, y - cy, -x - cx, -y - cy);
        if (sweep && angle < 0)
            angle += 2 * pi;
        if (!sweep && angle > 0)
            angle -= 2 * pi;
        if (isfinite(center.x) && isfinite(center.y) && isfinite(from) && isfinite(angle)) {
            failed(p, csg_svg_ellipse(pen, center, u, v, from, angle, p->tolerance));
            if (pen->point_count > 1) /* rounding: the end is the one that was written */
                pen->points[pen->point_count - 1] = to;
        }
    }
    failed(p, csg_outline_add(pen, to));
}

/* The control point of before, mirrored in `now`, when the command before was one of `kinds`. */
static csg_vec2 mirrored(const path *p, const char *kinds)
{
    if (!p->before || !strchr(kinds, p->before))
        return p->now;
    return (csg_vec2){2 * p->now.x - p->control.x, 2 * p->now.y - p->control.y};
}

static bool read_points(path *p, csg_vec2 origin, csg_vec2 *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!csg_svg_number(&p->at, &points[i].x) || !csg_svg_number(&p->at, &points[i].y))
            return false;
        points[i].x += origin.x;
        points[i].y += origin.y;
    }
    return true;
}

static bool line_to(path *p, char kind, csg_vec2 origin, csg_vec2 *to)
{
    double value;
    *to = p->now;
    if (kind == 'L' || kind == 'M') {
        if (!read_points(p, origin, to, 1))
            return false;
    } else if (!csg_svg_number(&p->at, &value)) {
        return false;
    } else if (kind == 'H') {
        to->x = origin.x + value;
    } else {
        to->y = origin.y + value;
    }
    failed(p, csg_outline_add(pen_of(p), *to));
    return true;
}

static bool arc_to(path *p, csg_vec2 origin, csg_vec2 *to)
{
    double rx, ry, turn;
    bool large, sweep;
    if (!csg_svg_number(&p->at, &rx) || !csg_svg_number(&p->at, &ry) ||
        !csg_svg_number(&p->at, &turn) || !read_flag(&p->at, &large) ||
        !read_flag(&p->at, &sweep) || !read_points(p, origin, to, 1))
        return false;
    draw_arc(p, rx, ry, turn, large, sweep, *to);
    return true;
}

/* C, S, Q, T: the smooth ones take their first control point from the curve before. */
static bool curve_to(path *p, char kind, csg_vec2 origin, csg_vec2 *to)
{
    csg_vec2 points[3];
    bool cubic = kind == 'C' || kind == 'S', smooth = kind == 'S' || kind == 'T';
    size_t count = cubic ? 3 : 2, given = count - smooth;
    if (smooth)
        points[0] = mirrored(p, cubic ? "CS" : "QT");
    if (!read_points(p, origin, points + smooth, given))
        return false;
    csg_outline *pen = pen_of(p);
    *to = points[count - 1];
    p->control = points[count - 2];
    failed(p, cubic ? csg_outline_cubic(pen, p->now, points[0], points[1], *to, p->tolerance)
                    : csg_outline_quadratic(pen, p->now, points[0], *to, p->tolerance));
    return true;
}

static bool move_to(path *p, csg_vec2 origin)
{
    csg_vec2 to;
    if (!read_points(p, origin, &to, 1))
        return false;
    end_subpath(p, false);
    p->start = p->now = to;
    return true;
}

/* One command with one set of numbers. */
static bool draw(path *p, char command)
{
    char kind = (char)(command & ~0x20);
    csg_vec2 origin = command == kind ? (csg_vec2){0, 0} : p->now, to = p->now;
    bool good = true;
    switch (kind) {
    case 'M':
        good = move_to(p, origin);
        to = p->now;
        break;
    case 'L':
    case 'H':
    case 'V':
        good = line_to(p, kind, origin, &to);
        break;
    case 'C':
    case 'S':
    case 'Q':
    case 'T':
        good = curve_to(p, kind, origin, &to);
        break;
    case 'A':
        good = arc_to(p, origin, &to);
        break;
    default:
        return false;
    }
    p->now = good ? to : p->now;
    p->before = kind;
    return good && fabs(to.x) <= CSG_INPUT_MOST_COORDINATE &&
           fabs(to.y) <= CSG_INPUT_MOST_COORDINATE;
}

static bool is_command(char c)
{
    return c && strchr("MmLlHhVvCcSsQqTtAaZz", c);
}

csgm_status csg_svg_path(const char *text, double tolerance, csg_polylines *out, bool *broken)
{
    path p = {.at = text, .out = out, .tolerance = tolerance};
    char command = 0;
    bool good = true;
    for (skip_blanks(&p.at); *p.at && good && p.status == CSGM_OK; skip_comma(&p.at)) {
        bool named = is_command(*p.at);
        if (named)
            command = *p.at++;
        else if (command == 'M' || command == 'm') /* further points are lines */
            command = command == 'M' ? 'L' : 'l';
        if (command == 0 || (command != 'M' && command != 'm' && !p.before)) {
            good = false;
        } else if (command == 'Z' || command == 'z') {
            good = named;
            end_subpath(&p, true);
            p.now = p.start;
            p.before = 'Z';
        } else {
            good = draw(&p, command);
        }
        if (p.out->pen.point_count > CSG_INPUT_MOST_POINTS)
            p.status = CSGM_ERR_LIMIT;
    }
    *broken |= !good;
    end_subpath(&p, false);
    return p.status;
}
