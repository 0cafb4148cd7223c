/* SPDX-License-Identifier: MIT
 * Triangles and points of them; see cut_polygons.h.
 */
#include "mesh/adaptive/cut_polygons.h"

#include <math.h>

/* Points asked at once; of one piece there are fewer. */
enum { MOST_OF_ONE = 4 * CSG_POLYGON_MOST, MOST = 4 * MOST_OF_ONE };

/* Cosine between the normals of a triangle and of its sheet: below it, the triangle looks away. */
static const double LOOKS_AWAY = 0;
/* Of the tolerance: fans that are so near have their creases as edges, up to the apex at least. The
 * first is how far what they cut off may be from them: where sheets meet whose normals are turned
 * from their mean by an angle, it is as far as the fan is from the sheets, over the cosine of that.
 */
static const double NEAR = 0.55, NEAR_ANYWAY = 0.2;

typedef struct points {
    float x[MOST + CSG_LANES], y[MOST + CSG_LANES], z[MOST + CSG_LANES], f[MOST + CSG_LANES];
    int count;
} points;

int csg_cut_triangle_count(const csg_cut_polygon *p)
{
    return p->is_fan ? p->polygon.count : p->polygon.count - 2;
}

void csg_cut_triangle(const csg_cut_polygon *p, int t, int corner[3], csg_vec3 at[3])
{
    const int around[3] = {-1, t, (t + 1) % p->polygon.count};
    for (int k = 0; k < 3; k++) {
        corner[k] = p->is_fan ? around[k] : p->cut[3 * t + k];
        at[k] = corner[k] < 0 ? p->apex : p->polygon.point[corner[k]].at;
    }
}

bool csg_cut_plain(csg_cut_polygon *piece)
{
    const csg_polygon *p = &piece->polygon;
    uint8_t edge[CSG_CELL_EDGES], triangles[CSG_CELL_MOST_INDICES];
    piece->is_fan = false;
    if (p->count > CSG_CELL_MOST_TRIANGLES + 2)
        return false; /* joined through faces: no loop of the tables, whose cuts meet nowhere */
    for (int i = 0; i < p->count; i++)
        edge[i] = (uint8_t)p->vertex[i];
    if (!csg_cell_cut(edge, p->count, triangles))
        return false;
    for (int i = 0; i < 3 * (p->count - 2); i++) {
        int at = 0;
        while (at < p->count - 1 && p->vertex[at] != triangles[i])
            at++;
        piece->cut[i] = (uint8_t)at;
    }
    return true;
}

/* ---- between vertices in faces -----------------------------------------------------------------
 */

enum { MOST_BETWEEN = CSG_CUT_MOST_CORNERS / 3 + 2 /* vertices */ };

/* Cosine: where gradients are farther from their mean, an edge may lie between them. */
static const double ONE_WAY = 0.95;
/* Of its length: what a diagonal costs where the surface is plane. */
static const double LENGTH_SHARE = 0.02;

/* How far the surface is from the middle of a diagonal, by the tangent planes at its ends: an
 * eighth of what they differ by there, a quarter of how far an end on a crease is from the other's
 * plane. Two such ends are on one sheet at least, and may be on one crease. INFINITY: it would lie
 * in a face, where the next cell may have it, too. */
static double cost_of(const csg_polygon *p, int a, int b)
{
    if (p->faces[a] & p->faces[b])
        return INFINITY;
    csg_vec3 way = csg_vec3_sub(p->point[b].at, p->point[a].at), turn = {0, 0, 0};
    if (!p->is_crease[a])
        turn = csg_vec3_sub(turn, csg_vec3_normalize(p->point[a].gradient));
    if (!p->is_crease[b])
        turn = csg_vec3_add(turn, csg_vec3_normalize(p->point[b].gradient));
    double share = p->is_crease[a] == p->is_crease[b] ? 1.0 / 8 : 1.0 / 4;
    return share * fabs(csg_vec3_dot(way, turn)) + LENGTH_SHARE * csg_vec3_norm(way);
}

/* Puts the triangles between two vertices, and those behind theirs, into the cut. */
static int list_triangles(uint8_t apex[MOST_BETWEEN][MOST_BETWEEN], int a, int b, int count,
                          uint8_t *cut)
{
    if (b - a < 2)
        return count;
    int c = apex[a][b];
    cut[3 * count] = (uint8_t)a, cut[3 * count + 1] = (uint8_t)c, cut[3 * count + 2] = (uint8_t)b;
    count = list_triangles(apex, a, c, count + 1, cut);
    return list_triangles(apex, c, b, count, cut);
}

/* The cheapest diagonals, by those of ever more vertices in a row. */
static bool choose_cut(csg_cut_polygon *piece)
{
    const csg_polygon *p = &piece->polygon;
    double least[MOST_BETWEEN][MOST_BETWEEN] = {{0}};
    uint8_t apex[MOST_BETWEEN][MOST_BETWEEN];
    int n = p->count;
    for (int width = 2; width < n; width++)
        for (int a = 0; a + width < n; a++) {
            int b = a + width;
            least[a][b] = INFINITY;
            for (int c = a + 1; c < b; c++) {
                double sum = least[a][c] + least[c][b];
                if (sum < least[a][b]) {
                    least[a][b] = sum;
                    apex[a][b] = (uint8_t)c;
                }
            }
            if (width < n - 1)
                least[a][b] += cost_of(p, a, b);
        }
    return least[0][n - 1] < INFINITY && list_triangles(apex, 0, n - 1, 0, piece->cut) == n - 2;
}

/* Whether triangles, and those of a fan around the middle, all look one way: then they meet
 * nowhere. */
static bool looks_one_way(const csg_cut_polygon *piece)
{
    const csg_polygon *p = &piece->polygon;
    csg_vec3 middle = {0, 0, 0}, mean = {0, 0, 0};
    for (int i = 0; i < p->count; i++)
        middle = csg_vec3_add(middle, csg_vec3_scale(p->point[i].at, 1.0 / p->count));
    for (int i = 0; i < p->count; i++) {
        csg_vec3 a = csg_vec3_sub(p->point[i].at, middle),
                 b = csg_vec3_sub(p->point[(i + 1) % p->count].at, middle);
        mean = csg_vec3_add(mean, csg_vec3_cross(a, b));
    }
    for (int i = 0; i < p->count; i++) {
        csg_vec3 a = csg_vec3_sub(p->point[i].at, middle),
                 b = csg_vec3_sub(p->point[(i + 1) % p->count].at, middle);
        if (!(csg_vec3_dot(mean, csg_vec3_cross(a, b)) > 0))
            return false;
    }
    for (int t = 0; t < csg_cut_triangle_count(piece); t++) {
        int corner[3];
        csg_vec3 v[3];
        csg_cut_triangle(piece, t, corner, v);
        csg_vec3 n = csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0]));
        if (!(csg_vec3_dot(mean, n) > 0))
            return false;
    }
    return true;
}

/* Whether a diagonal leads from each crease point to another: no crease ends in the cell. */
static bool joins_creases(const csg_cut_polygon *piece)
{
    const csg_polygon *p = &piece->polygon;
    unsigned joined = 0, creases = 0;
    for (int i = 0; i < p->count; i++)
        creases |= (unsigned)p->is_crease[i] << i;
    for (int i = 0; i < 3 * (p->count - 2); i++) {
        unsigned a = piece->cut[i], b = piece->cut[i % 3 == 2 ? i - 2 : i + 1];
        if (creases >> a & creases >> b & 1)
            joined |= 1u << a | 1u << b;
    }
    return joined == creases;
}

bool csg_cut_without_apex(csg_cut_polygon *piece)
{
    const csg_polygon *p = &piece->polygon;
    if (!p->in_faces)
        return csg_cut_plain(piece);
    piece->is_fan = false;
    int creases = csg_polygon_crease_count(p);
    if (creases ? creases == 1 || p->is_torn : !(csg_polygon_least_cosine(p) > ONE_WAY))
        return false; /* a crease that ends in the cell does so in an apex */
    return p->count <= MOST_BETWEEN && choose_cut(piece) && joins_creases(piece) &&
           looks_one_way(piece);
}

/* ---- distances ---------------------------------------------------------------------------------
 */

/* The gradient that a triangle's sheet has: of a vertex of it that is on no crease. */
static csg_vec3 gradient_of(const csg_polygon *p, const int corner[3])
{
    for (int k = 0; k < 3; k++)
        if (corner[k] >= 0 && !p->is_crease[corner[k]])
            return p->point[corner[k]].gradient;
    return csg_vec3_make(0, 0, 0);
}

static double slope_of(const csg_polygon *p)
{
    double slope = INFINITY;
    for (int i = 0; i < p->count; i++)
        if (!p->is_crease[i])
            slope = fmin(slope, csg_vec3_norm(p->point[i].gradient));
    return slope;
}

static void add_point(points *q, csg_vec3 at)
{
    q->x[q->count] = (float)at.x, q->y[q->count] = (float)at.y, q->z[q->count] = (float)at.z;
    q->count++;
}

/* False: a triangle looks inwards. */
static bool add_points(points *q, const csg_cut_polygon *piece, double least_height)
{
    for (int t = 0; t < csg_cut_triangle_count(piece); t++) {
        int corner[3];
        csg_vec3 v[3];
        csg_cut_triangle(piece, t, corner, v);
        csg_vec3 a = v[0], b = v[1], c = v[2], g = gradient_of(&piece->polygon, corner);
        csg_vec3 cross = csg_vec3_cross(csg_vec3_sub(b, a), csg_vec3_sub(c, a));
        csg_vec3 longest = csg_vec3_sub(b, c);
        double height = csg_vec3_norm(cross) / fmax(csg_vec3_norm(longest), 1e-30);
        if (height > least_height && -csg_gradients_cosine(cross, g) < LOOKS_AWAY)
            return false;
        add_point(q, csg_vec3_scale(csg_vec3_add(a, csg_vec3_add(b, c)), 1.0 / 3));
        add_point(q, csg_vec3_scale(csg_vec3_add(a, b), 0.5));
        add_point(q, csg_vec3_scale(csg_vec3_add(b, c), 0.5));
        if (!piece->is_fan) /* the next triangle of a fan has it */
            add_point(q, csg_vec3_scale(csg_vec3_add(c, a), 0.5));
        if (!piece->is_fan && piece->polygon.in_faces) /* it is large */
            for (int k = 0; k < 3; k++)
                add_point(q,
                          csg_vec3_add(csg_vec3_scale(v[k], 0.4),
                                       csg_vec3_scale(csg_vec3_add(a, csg_vec3_add(b, c)), 0.2)));
    }
    return true;
}

static void ask(csg_sheet_probe *probe, points *q)
{
    for (int i = q->count; i % CSG_LANES; i++)
        q->x[i] = q->x[0], q->y[i] = q->y[0], q->z[i] = q->z[0];
    if (q->count)
        probe->kernel->values(probe->tape, q->x, q->y, q->z, (size_t)q->count, q->f, probe->scratch,
                              probe->scratch_floats);
    probe->evaluations += (uint64_t)q->count;
}

/* As many pieces as there is room for, from the first on. */
static int find_some(csg_sheet_probe *probe, csg_cut_polygon *const *pieces, int count,
                     double least_height)
{
    enum { PIECES = 64 };
    points q;
    int end[PIECES], n = 0;
    q.count = 0;
    for (; n < count && n < PIECES && q.count + MOST_OF_ONE <= MOST; n++) {
        int first = q.count;
        bool looks_out = add_points(&q, pieces[n], least_height);
        pieces[n]->distance = looks_out ? 0 : INFINITY;
        if (!looks_out)
            q.count = first;
        end[n] = q.count;
    }
    ask(probe, &q);
    for (int k = 0, i = 0; k < n; k++) {
        double worst = 0, slope = slope_of(&pieces[k]->polygon);
        for (; i < end[k]; i++)
            worst = fmax(worst, fabs((double)q.f[i]));
        double distance = slope > 0 ? fmax(worst - 4 * probe->noise, 0) / slope : INFINITY;
        pieces[k]->distance = fmax(pieces[k]->distance, distance);
    }
    return n;
}

void csg_cuts_find_distances(csg_sheet_probe *probe, csg_cut_polygon *const *pieces, int count,
                             double least_height)
{
    for (int done = 0; done < count;)
        done += find_some(probe, pieces + done, count - done, least_height);
}

void csg_cuts_settle_near(csg_cut_polygon *const *fans, int count, double tolerance)
{
    for (int i = 0; i < count; i++) {
        double near = NEAR * csg_polygon_least_cosine(&fans[i]->polygon);
        if (!(fans[i]->distance <= fmax(near, NEAR_ANYWAY) * tolerance))
            continue;
        fans[i]->polygon.is_torn = false;
        if (fans[i]->kind == CSG_APEX_FAILED)
            fans[i]->kind = CSG_APEX_CREASE;
    }
}

/* ---- apart -------------------------------------------------------------------------------------
 */

static bool is_beside(const csg_cut_polygon *p, const csg_cut_polygon *other, double margin)
{
    for (int t = 0; t < csg_cut_triangle_count(p); t++) {
        int corner[3];
        csg_vec3 v[3];
        csg_cut_triangle(p, t, corner, v);
        csg_vec3 n =
            csg_vec3_normalize(csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0])));
        double low = INFINITY, high = -INFINITY;
        for (int i = other->is_fan ? -1 : 0; i < other->polygon.count; i++) {
            csg_vec3 at = i < 0 ? other->apex : other->polygon.point[i].at;
            double d = csg_vec3_dot(n, csg_vec3_sub(at, v[0]));
            low = fmin(low, d);
            high = fmax(high, d);
        }
        if (!(low > margin || high < -margin))
            return false;
    }
    return true;
}

bool csg_cuts_are_apart(const csg_cut_polygon *one, const csg_cut_polygon *other, double margin)
{
    return is_beside(one, other, margin) || is_beside(other, one, margin);
}
