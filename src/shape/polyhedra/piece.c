/* SPDX-License-Identifier: MIT
 * Convex polygons and their cuts by planes; see piece.h. Cuts are rounded: parts may leave gaps of
 * some 2^-50 of the frame, which the slack of a side covers.
 */
#include "shape/polyhedra/piece.h"

csg_vec3 csg_piece_center(const csg_piece *piece)
{
    csg_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < piece->count; i++)
        sum = csg_vec3_add(sum, piece->corners[i]);
    return csg_vec3_scale(sum, 1.0 / piece->count);
}

double csg_piece_radius(const csg_piece *piece, csg_vec3 center)
{
    double most = 0;
    for (uint32_t i = 0; i < piece->count; i++) {
        csg_vec3 away = csg_vec3_sub(piece->corners[i], center);
        most = fmax(most, csg_vec3_dot(away, away));
    }
    return sqrt(most);
}

double csg_piece_bound(const csg_piece *piece, const csg_tree_triangle *triangle, uint32_t *corner)
{
    double most = -1;
    for (uint32_t i = 0; i < piece->count; i++) {
        double squared = csg_triangle_squared(triangle, piece->corners[i]);
        if (squared > most) {
            most = squared;
            *corner = i;
        }
    }
    return sqrt(most);
}

bool csg_piece_is_within(const csg_piece *piece, const csg_tree_triangle *triangle, double enough)
{
    for (uint32_t i = 0; i < piece->count; i++)
        if (!(csg_triangle_squared(triangle, piece->corners[i]) <= enough * enough))
            return false;
    return true;
}

static void add_corner(csg_piece *piece, csg_vec3 p)
{
    piece->corners[piece->count++] = p;
}

/* Twice the area, of the fan from the first corner: right for convex polygons. */
static double area_of(const csg_piece *piece)
{
    csg_vec3 sum = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < piece->count; i++)
        sum = csg_vec3_add(sum,
                           csg_vec3_cross(csg_vec3_sub(piece->corners[i], piece->corners[0]),
                                          csg_vec3_sub(piece->corners[i + 1], piece->corners[0])));
    return csg_vec3_norm(sum);
}

/* Both sides of the plane normal . (p - on) = 0; `above` where it is positive. An empty side has
 * fewer than three corners. Corners very near to the plane count as on it: no splinters. A convex
 * polygon grows by one corner per side at most. */
static void split(const csg_piece *piece, csg_vec3 on, csg_vec3 normal, csg_piece *above,
                  csg_piece *below)
{
    double height[CSG_PIECE_CORNERS];
    above->count = below->count = 0;
    above->hint = below->hint = piece->hint;
    double on_plane = 0x1p-42 * csg_vec3_norm(normal);
    for (uint32_t i = 0; i < piece->count; i++) {
        height[i] = csg_vec3_dot(csg_vec3_sub(piece->corners[i], on), normal);
        height[i] = fabs(height[i]) > on_plane ? height[i] : 0;
    }
    for (uint32_t i = 0; i < piece->count; i++) {
        uint32_t j = i + 1 < piece->count ? i + 1 : 0;
        csg_vec3 p = piece->corners[i], q = piece->corners[j];
        if (height[i] >= 0)
            add_corner(above, p);
        if (height[i] <= 0)
            add_corner(below, p);
        if ((height[i] > 0 && height[j] < 0) || (height[i] < 0 && height[j] > 0)) {
            double t = height[i] / (height[i] - height[j]);
            csg_vec3 cut = csg_vec3_add(p, csg_vec3_scale(csg_vec3_sub(q, p), t));
            add_corner(above, cut);
            add_corner(below, cut);
        }
    }
}

/* Most corners of a piece that is cut by one plane; one that is cut by three may have one more. */
enum { HALVED_MOST = 8 };

/* Along a chord between corners: no new ones. */
static uint32_t halve_by_chord(const csg_piece *piece, csg_piece *parts)
{
    uint32_t half = piece->count / 2;
    parts[0] = parts[1] = *piece;
    parts[0].count = half + 1;
    parts[1].count = 0;
    for (uint32_t i = half; i <= piece->count; i++)
        add_corner(&parts[1], piece->corners[i % piece->count]);
    return 2;
}

uint32_t csg_piece_halve(const csg_piece *piece, csg_piece *parts)
{
    if (piece->count > HALVED_MOST)
        return halve_by_chord(piece, parts);
    uint32_t from = 0, to = 0;
    double most = -1;
    for (uint32_t i = 0; i < piece->count; i++)
        for (uint32_t j = 0; j < i; j++) {
            csg_vec3 away = csg_vec3_sub(piece->corners[i], piece->corners[j]);
            double d = csg_vec3_dot(away, away);
            if (d > most) {
                most = d;
                from = j;
                to = i;
            }
        }
    csg_vec3 along = csg_vec3_sub(piece->corners[to], piece->corners[from]);
    csg_vec3 middle = csg_vec3_add(piece->corners[from], csg_vec3_scale(along, 0.5));
    split(piece, middle, along, &parts[0], &parts[1]);
    if (parts[0].count < 3 || parts[1].count < 3) {
        parts[0] = *piece; /* too small to be cut */
        return 1;
    }
    return 2;
}

/* A cut that leaves more than this of the area in one part outside is none: that part would have to
 * be cut again. Splinters beside a large part inside are fine, the large one is settled. */
static const double PART_MOST = 0.9;

uint32_t csg_piece_cut(const csg_piece *piece, const csg_tree_triangle *triangle, csg_piece *parts)
{
    csg_vec3 normal = csg_vec3_cross(triangle->ab, triangle->ac);
    csg_vec3 b = csg_vec3_add(triangle->a, triangle->ab),
             c = csg_vec3_add(triangle->a, triangle->ac);
    const csg_vec3 starts[3] = {triangle->a, b, c};
    const csg_vec3 edges[3] = {triangle->ab, csg_vec3_sub(triangle->ac, triangle->ab),
                               csg_vec3_scale(triangle->ac, -1)};
    uint32_t count = 0;
    double most = 0, whole = area_of(piece);
    csg_piece rest = *piece, *inside = &rest;
    if (piece->count + 3 > CSG_PIECE_CORNERS)
        return 0;
    for (int k = 0; k < 3 && inside->count >= 3; k++) {
        csg_piece before = *inside;
        split(&before, starts[k], csg_vec3_cross(normal, edges[k]), inside, &parts[count]);
        if (parts[count].count >= 3)
            most = fmax(most, area_of(&parts[count++]));
    }
    if (inside->count >= 3)
        parts[count++] = *inside;
    /* a polygon that is only a line and lies on an edge's plane is on both sides of it, whole: no
     * cut */
    return most < PART_MOST * whole ? count : 0;
}

uint32_t csg_piece_divide(const csg_piece *piece, const csg_tree_triangle *triangle,
                          csg_vec3 center, csg_piece *parts)
{
    bool in_face;
    csg_triangle_foot(triangle, center, &in_face);
    uint32_t count = in_face ? csg_piece_cut(piece, triangle, parts) : 0;
    if (count < 2)
        count = csg_piece_halve(piece, parts);
    for (uint32_t i = 0; i < count; i++) {
        parts[i].bound = piece->bound;
        parts[i].hint = piece->hint;
    }
    return count;
}

/* What rounding in double can make of the distance to one triangle: its normal is off by 2^-51 over
 * its thinness, over the length of the triangle; needles are taken for their edges. */
static double slack_of(const csg_tree_triangle *t)
{
    csg_vec3 bc = csg_vec3_sub(t->ac, t->ab), normal = csg_vec3_cross(t->ab, t->ac);
    double longest2 =
        fmax(csg_vec3_dot(bc, bc), fmax(csg_vec3_dot(t->ab, t->ab), csg_vec3_dot(t->ac, t->ac)));
    double longest = sqrt(longest2);
    return t->is_needle ? 0x1p-26 * longest : 0x1p-50 * longest * longest2 / csg_vec3_norm(normal);
}

double csg_piece_slack(const csg_tree *tree)
{
    double most = 0;
    for (size_t i = 0; i < tree->count; i++)
        most = fmax(most, slack_of(&tree->triangles[i]));
    return most + 0x1p-48;
}
