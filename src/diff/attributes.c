/* SPDX-License-Identifier: MIT
 * Attributes corner by corner; see attributes.h. A vertex may be split in one mesh and not in the
 * other, so it is corners of triangles that are compared.
 */
#include "diff/attributes.h"

#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "io/parts.h"

static uint32_t corner_of(const csg_diff_side *side, const csg_diff_face *face, uint32_t corner)
{
    return side->view->indices[3 * (size_t)face->triangle + (face->turned + corner) % 3];
}

/* A difference between two vertices; `largest` is kept of those that it returns. */
typedef double difference_fn(const csg_diff_pair *pair, uint32_t a, uint32_t b);

static void compare_corners(const csg_diff_pair *pair, const csg_diff_match *match,
                            difference_fn *difference, double allowed, csgm_diff_attribute *out)
{
    uint64_t differing = 0;
    for (size_t t = 0; t < match->count; t++)
        for (uint32_t k = 0; k < 3; k++) {
            double d = difference(pair, corner_of(&pair->sides[0], &match->faces[0][t], k),
                                  corner_of(&pair->sides[1], &match->faces[1][t], k));
            out->largest = fmax(out->largest, d);
            differing += d > allowed;
        }
    out->is_compared = true;
    out->share = match->count ? (double)differing / (3.0 * (double)match->count) : 0;
}

/* ---- normals -------------------------------------------------------------------------------- */

static csg_vec3 normal_of(const csg_diff_side *side, uint32_t vertex)
{
    const float *n = side->view->normals + 3 * (size_t)vertex;
    csg_vec3 normal = csg_vec3_from_floats(n);
    return csg_vec3_normalize(csg_diff_turned(side->turn, normal));
}

/* In degrees. No normal (a critical point of the field) is like any. */
static double angle_between(const csg_diff_pair *pair, uint32_t a, uint32_t b)
{
    csg_vec3 m = normal_of(&pair->sides[0], a), n = normal_of(&pair->sides[1], b);
    if (csg_vec3_dot(m, m) == 0 || csg_vec3_dot(n, n) == 0)
        return 0;
    double sine = csg_vec3_norm(csg_vec3_cross(m, n));
    return csg_atan2(sine, csg_vec3_dot(m, n)) * 180 / csg_acos(-1);
}

void csg_diff_compare_normals(const csg_diff_pair *pair, const csg_diff_match *match,
                              csgm_diff_attribute *out)
{
    *out = (csgm_diff_attribute){.is_compared = false};
    if (pair->sides[0].view->normals && pair->sides[1].view->normals)
        compare_corners(pair, match, angle_between, 1, out);
}

/* ---- colours -------------------------------------------------------------------------------- */

static double material_of(const csgm_mesh_view *view, uint32_t vertex, int which)
{
    static const double defaults[2] = {CSG_MATERIAL_METALLIC, CSG_MATERIAL_ROUGHNESS};
    return view->materials ? (double)view->materials[2 * (size_t)vertex + (size_t)which]
                           : defaults[which];
}

static double color_between(const csg_diff_pair *pair, uint32_t a, uint32_t b)
{
    const csgm_mesh_view *x = pair->sides[0].view, *y = pair->sides[1].view;
    double largest = 0;
    for (size_t k = 0; k < 4 && x->colors; k++)
        largest = fmax(largest, fabs((double)x->colors[4 * (size_t)a + k] -
                                     (double)y->colors[4 * (size_t)b + k]));
    for (int k = 0; k < 2; k++)
        largest = fmax(largest, 255.0 / CSG_MATERIAL_ONE *
                                    fabs(material_of(x, a, k) - material_of(y, b, k)));
    return largest;
}

void csg_diff_compare_colors(const csg_diff_pair *pair, const csg_diff_match *match,
                             csgm_diff_attribute *out)
{
    const csgm_mesh_view *a = pair->sides[0].view, *b = pair->sides[1].view;
    *out = (csgm_diff_attribute){.is_compared = false};
    if (!a->colors != !b->colors)
        *out = (csgm_diff_attribute){true, 255, 1};
    else if (a->colors || a->materials || b->materials)
        compare_corners(pair, match, color_between, 1, out);
}

/* ---- names ---------------------------------------------------------------------------------- */

static int compare_names(const void *left, const void *right)
{
    const char *const *a = left, *const *b = right;
    return strcmp(*a, *b);
}

/* Of a view's parts; one without a name has the empty one. */
static const char **names_of(csg_diff_pair *pair, const csgm_mesh_view *view, bool sorted)
{
    size_t count = (size_t)csg_part_count(view);
    const char **names = csg_arena_alloc(&pair->arena, count * sizeof *names);
    if (!names)
        return NULL;
    names[0] = "";
    for (size_t i = 0; i < view->part_count; i++)
        names[i] = view->parts[i].name ? view->parts[i].name : "";
    if (sorted)
        qsort(names, count, sizeof *names, compare_names);
    return names;
}

csgm_status csg_diff_compare_names(csg_diff_pair *pair, bool in_any_order, csgm_diff_attribute *out)
{
    const csgm_mesh_view *a = pair->sides[0].view, *b = pair->sides[1].view;
    const char **left = names_of(pair, a, in_any_order), **right = names_of(pair, b, in_any_order);
    if (!left || !right)
        return csg_context_no_memory(pair->context);
    size_t m = (size_t)csg_part_count(a), n = (size_t)csg_part_count(b), both = m < n ? m : n;
    size_t differing = m + n - 2 * both;
    for (size_t i = 0; i < both; i++)
        differing += strcmp(left[i], right[i]) != 0;
    *out =
        (csgm_diff_attribute){true, (double)differing, (double)differing / (double)(m + n - both)};
    return CSGM_OK;
}
