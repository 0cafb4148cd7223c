/* SPDX-License-Identifier: MIT
 * Values of SVG attributes; see svg_value.h.
 */
#include "outline/svg/svg_value.h"

#include <string.h>

#include "base/elementary.h"
#include "outline/svg/svg_path.h"

static const double pi = 3.14159265358979323846;

/* ---- lengths ------------------------------------------------------------------------ */

bool csg_svg_length(const char *text, double *value, csg_svg_unit *unit)
{
    static const struct {
        const char *name;
        double pixels;
    } units[] = {{"px", 1},         {"in", 96},       {"cm", 96 / 2.54}, {"mm", 96 / 25.4},
                 {"pt", 96.0 / 72}, {"pc", 96.0 / 6}, {"em", 16},        {"ex", 8}};
    while (csg_is_blank(*text))
        text++;
    if (!csg_number_scan(&text, text + strnlen(text, 600), value) ||
        fabs(*value) > CSG_INPUT_MOST_COORDINATE)
        return false;
    size_t length = strlen(text);
    while (length && csg_is_blank(text[length - 1]))
        length--;
    *unit = length == 0 ? CSG_SVG_UNIT_NONE : CSG_SVG_UNIT_PX;
    if (length == 0)
        return true;
    if (length == 1 && *text == '%') {
        *unit = CSG_SVG_UNIT_PERCENT;
        return true;
    }
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (length == 2 && strncmp(text, units[i].name, 2) == 0) {
            *value *= units[i].pixels;
            return true;
        }
    return false;
}

double csg_svg_attribute(const csg_xml *xml, uint32_t element, const char *name, double whole,
                         double otherwise)
{
    const char *text = csg_xml_get(xml, element, name);
    double value;
    csg_svg_unit unit;
    if (!text || !csg_svg_length(text, &value, &unit))
        return otherwise;
    return unit == CSG_SVG_UNIT_PERCENT ? value / 100 * whole : value;
}

/* ---- transforms --------------------------------------------------------------------- */

csg_affine csg_svg_matrix(double a, double b, double c, double d, double e, double f)
{
    csg_affine map = csg_affine_identity();
    map.m[0][0] = a, map.m[0][1] = c, map.t[0] = e;
    map.m[1][0] = b, map.m[1][1] = d, map.t[1] = f;
    return map;
}

static csg_affine turn(double degrees)
{
    return csg_affine_rotate(fmod(degrees, 360), csg_vec3_make(0, 0, 1));
}

static csg_affine shift(double x, double y)
{
    return csg_affine_translate(csg_vec3_make(x, y, 0));
}

/* One transform of a list by its name. */
static bool one_transform(const char *name, size_t length, const double *v, size_t count,
                          csg_affine *out)
{
#define IS(text) (length == sizeof(text) - 1 && memcmp(name, text, length) == 0)
    if (IS("matrix") && count == 6)
        *out = csg_svg_matrix(v[0], v[1], v[2], v[3], v[4], v[5]);
    else if (IS("translate") && (count == 1 || count == 2))
        *out = shift(v[0], count == 2 ? v[1] : 0);
    else if (IS("scale") && (count == 1 || count == 2))
        *out = csg_affine_scale(csg_vec3_make(v[0], v[count - 1], 1));
    else if (IS("rotate") && count == 1)
        *out = turn(v[0]);
    else if (IS("rotate") && count == 3)
        *out = csg_affine_multiply(csg_affine_multiply(shift(v[1], v[2]), turn(v[0])),
                                   shift(-v[1], -v[2]));
    else if (IS("skewX") && count == 1)
        *out = csg_svg_matrix(1, 0, csg_tan(fmod(v[0], 180) * pi / 180), 1, 0, 0);
    else if (IS("skewY") && count == 1)
        *out = csg_svg_matrix(1, csg_tan(fmod(v[0], 180) * pi / 180), 0, 1, 0, 0);
    else
        return false;
    return true;
#undef IS
}

static void skip_to_next(const char **at)
{
    while (csg_is_blank(**at) || **at == ',')
        ++*at;
}

bool csg_svg_transform(const char *text, csg_affine *out)
{
    csg_affine map = csg_affine_identity();
    *out = map;
    for (skip_to_next(&text); *text; skip_to_next(&text)) {
        const char *name = text;
        double values[6];
        size_t count = 0;
        csg_affine one;
        text += strspn(text, "abcdefghijklmnopqrstuvwxyzXY");
        size_t length = (size_t)(text - name);
        skip_to_next(&text);
        if (*text++ != '(')
            return false;
        while (count < 6 && csg_svg_number(&text, &values[count]))
            count++;
        skip_to_next(&text);
        if (*text++ != ')' || !one_transform(name, length, values, count, &one))
            return false;
        map = csg_affine_multiply(map, one);
    }
    *out = map;
    return true;
}

/* ---- view boxes --------------------------------------------------------------------- */

static double alignment(const char *text, const char *axis)
{
    const char *at = strstr(text, axis);
    if (!at)
        return 0.5;
    return strncmp(at + 1, "Min", 3) == 0 ? 0 : strncmp(at + 1, "Max", 3) == 0 ? 1 : 0.5;
}

csg_svg_view csg_svg_view_of(const csg_xml *xml, uint32_t element)
{
    csg_svg_view view = {.align_x = 0.5, .align_y = 0.5};
    const char *box = csg_xml_get(xml, element, "viewBox");
    const char *ratio = csg_xml_get(xml, element, "preserveAspectRatio");
    if (!box || !csg_svg_number(&box, &view.x) || !csg_svg_number(&box, &view.y) ||
        !csg_svg_number(&box, &view.width) || !csg_svg_number(&box, &view.height) ||
        !(view.width > 0 && view.height > 0))
        view.x = view.y = view.width = view.height = 0;
    if (ratio) {
        view.stretch = strncmp(ratio, "none", 4) == 0;
        view.slice = strstr(ratio, "slice") != NULL;
        view.align_x = alignment(ratio, "x");
        view.align_y = alignment(ratio, "Y");
    }
    return view;
}

csg_affine csg_svg_view_map(const csg_svg_view *view, double width, double height)
{
    if (view->width <= 0)
        return csg_affine_identity();
    double x = width / view->width, y = height / view->height;
    if (!view->stretch)
        x = y = view->slice ? fmax(x, y) : fmin(x, y);
    return csg_svg_matrix(x, 0, 0, y, (width - x * view->width) * view->align_x - x * view->x,
                          (height - y * view->height) * view->align_y - y * view->y);
}

/* ---- style -------------------------------------------------------------------------- */

/* A value without the blanks around it. */
typedef struct piece {
    const char *text;
    size_t length;
} piece;

static piece trimmed(const char *begin, const char *end)
{
    while (begin < end && csg_is_blank(*begin))
        begin++;
    while (end > begin && csg_is_blank(end[-1]))
        end--;
    return (piece){begin, (size_t)(end - begin)};
}

static bool piece_is(piece p, const char *text)
{
    return p.length == strlen(text) && memcmp(p.text, text, p.length) == 0;
}

/* In the style attribute, else the attribute of that name. Empty: neither. */
static piece property(const csg_xml *xml, uint32_t element, const char *name)
{
    const char *style = csg_xml_get(xml, element, "style");
    while (style && *style) {
        const char *end = strchrnul(style, ';'), *colon = memchr(style, ':', (size_t)(end - style));
        if (colon && piece_is(trimmed(style, colon), name))
            return trimmed(colon + 1, end);
        style = *end ? end + 1 : NULL;
    }
    const char *value = csg_xml_get(xml, element, name);
    return value ? trimmed(value, value + strlen(value)) : (piece){"", 0};
}

csg_svg_style csg_svg_style_initial(void)
{
    return (csg_svg_style){.stroke_width = 1, .cap = CSG_CAP_SQUARE, .miter_limit = 4};
}

static void apply_none(const csg_xml *xml, uint32_t element, const char *name, bool *none)
{
    piece value = property(xml, element, name);
    if (value.length && !piece_is(value, "inherit"))
        *none = piece_is(value, "none");
}

static void apply_number(const csg_xml *xml, uint32_t element, const char *name, double *number)
{
    piece value = property(xml, element, name);
    char text[64];
    double read;
    csg_svg_unit unit;
    if (!value.length || value.length >= sizeof text)
        return;
    memcpy(text, value.text, value.length);
    text[value.length] = 0;
    if (csg_svg_length(text, &read, &unit) && unit != CSG_SVG_UNIT_PERCENT && read >= 0)
        *number = read;
}

void csg_svg_style_apply(const csg_xml *xml, uint32_t element, csg_svg_style *style)
{
    apply_none(xml, element, "fill", &style->fill_none);
    apply_none(xml, element, "stroke", &style->stroke_none);
    apply_number(xml, element, "stroke-width", &style->stroke_width);
    apply_number(xml, element, "stroke-miterlimit", &style->miter_limit);
    piece rule = property(xml, element, "fill-rule");
    if (rule.length && !piece_is(rule, "inherit"))
        style->even_odd = piece_is(rule, "evenodd");
    piece cap = property(xml, element, "stroke-linecap");
    if (cap.length && !piece_is(cap, "inherit"))
        style->cap = piece_is(cap, "round")    ? CSG_CAP_ROUND
                     : piece_is(cap, "square") ? CSG_CAP_SQUARE
                                               : CSG_CAP_BUTT;
    piece join = property(xml, element, "stroke-linejoin");
    if (join.length && !piece_is(join, "inherit"))
        style->join = piece_is(join, "round")   ? CSG_LINE_JOIN_ROUND
                      : piece_is(join, "bevel") ? CSG_LINE_JOIN_BEVEL
                                                : CSG_LINE_JOIN_MITER;
}

bool csg_svg_property_is(const csg_xml *xml, uint32_t element, const char *name, const char *value)
{
    return piece_is(property(xml, element, name), value);
}
