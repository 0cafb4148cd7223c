/* SPDX-License-Identifier: MIT
 * The straight roof over polygons with holes: one face of slope 1 per edge, the area that the edge
 * sweeps in the straight skeleton (shape/plane/skeleton.h), and the figure as the floor.
 *
 * Faces share the skeleton's arcs, so the polyhedron is closed whatever the numbers are. That it is
 * the roof is looked at: each face lies in its plane and none is folded.
 */
#include <stdlib.h>

#include "base/elementary.h"
#include "base/sets.h"
#include "shape/plane/polygons.h"
#include "shape/plane/skeleton.h"
#include "solid/operations.h"

typedef struct step { /* along the border of a face */
    uint32_t edge, from, to;
} step;

typedef struct roof {
    csg_memory *memory;
    const csg_outline *outline;
    csg_skeleton skeleton;
    csg_triangles triangles;
    uint32_t *same;          /* per node: the first one at its place that an arc leads to */
    step *steps;             /* by edge and from */
    uint32_t *border;        /* of one face */
    size_t step_count, made; /* steps that faces have */
    double size;
} roof;

/* Arcs without length go: their ends are one. */
static void join_ends(roof *r)
{
    const csg_skeleton *s = &r->skeleton;
    csg_sets_init(r->same, s->node_count);
    for (size_t i = 0; i < s->arc_count; i++) {
        const csg_skeleton_node *a = &s->nodes[s->arcs[i].from], *b = &s->nodes[s->arcs[i].to];
        if (csg_hypot(b->at.x - a->at.x, b->at.y - a->at.y) < 1e-10 * r->size)
            csg_sets_join(r->same, s->arcs[i].from, s->arcs[i].to);
    }
}

static int by_edge(const void *a, const void *b)
{
    const step *x = a, *y = b;
    if (x->edge != y->edge)
        return x->edge < y->edge ? -1 : 1;
    return x->from < y->from ? -1 : x->from > y->from;
}

static void add_step(roof *r, uint32_t edge, uint32_t from, uint32_t to)
{
    step s = {edge, csg_set_root(r->same, from), csg_set_root(r->same, to)};
    if (s.from != s.to)
        r->steps[r->step_count++] = s;
}

/* Counter-clockwise around each face: its edge, the arcs whose left it is, and backwards those
 * whose right it is. */
static void collect_steps(roof *r)
{
    const csg_outline *o = r->outline;
    for (size_t loop = 0; loop < o->loop_count; loop++) {
        uint32_t first = (uint32_t)csg_outline_first(o, loop);
        for (uint32_t i = first; i < o->ends[loop]; i++)
            add_step(r, i, i, i + 1 < o->ends[loop] ? i + 1 : first);
    }
    for (size_t i = 0; i < r->skeleton.arc_count; i++) {
        const csg_skeleton_arc *arc = &r->skeleton.arcs[i];
        add_step(r, arc->left, arc->from, arc->to);
        add_step(r, arc->right, arc->to, arc->from);
    }
    qsort(r->steps, r->step_count, sizeof *r->steps, by_edge);
}

/* From where in this face: NULL, or two ways, if it is no loop. */
static const step *step_from(const roof *r, uint32_t edge, uint32_t from)
{
    const step key = {edge, from, 0};
    return bsearch(&key, r->steps, r->step_count, sizeof key, by_edge);
}

static csg_vec3 place(const roof *r, uint32_t node)
{
    const csg_skeleton_node *n = &r->skeleton.nodes[node];
    return csg_vec3_make(n->at.x, n->at.y, n->time);
}

/* Does the node lie in the plane of slope 1 on this edge? */
static bool is_in_plane(const roof *r, uint32_t edge, uint32_t next, uint32_t node)
{
    csg_vec3 p = place(r, edge), q = place(r, next), at = place(r, node);
    double length = csg_hypot(q.x - p.x, q.y - p.y);
    double far = ((q.x - p.x) * (at.y - p.y) - (q.y - p.y) * (at.x - p.x)) / length;
    return fabs(far - at.z) < 1e-6 * r->size;
}

static bool is_folded(const roof *r, size_t first_triangle)
{
    for (size_t i = first_triangle; i < r->triangles.count; i++) {
        const uint32_t *t = r->triangles.corners[i];
        csg_vec3 a = place(r, t[0]), b = place(r, t[1]), c = place(r, t[2]);
        if ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < -1e-7 * r->size * r->size)
            return true;
    }
    return false;
}

static csgm_status add_face(roof *r, uint32_t edge, uint32_t next)
{
    uint32_t start = csg_set_root(r->same, edge), at = start;
    size_t count = 0, first = r->triangles.count;
    do {
        const step *s = count < r->step_count ? step_from(r, edge, at) : NULL;
        if (!s || !is_in_plane(r, edge, next, at))
            return CSGM_ERR_UNSUPPORTED;
        r->border[count++] = at;
        at = s->to;
    } while (at != start);
    r->made += count;
    if (count < 3)
        return CSGM_ERR_UNSUPPORTED;
    if (!csg_triangles_add_face(&r->triangles, r->border, count))
        return CSGM_ERR_MEMORY;
    return is_folded(r, first) ? CSGM_ERR_UNSUPPORTED : CSGM_OK;
}

static csgm_status add_faces(roof *r)
{
    const csg_outline *o = r->outline;
    csgm_status status = CSGM_OK;
    for (size_t loop = 0; loop < o->loop_count; loop++) {
        uint32_t first = (uint32_t)csg_outline_first(o, loop);
        for (uint32_t i = first; i < o->ends[loop] && status == CSGM_OK; i++)
            status = add_face(r, i, i + 1 < o->ends[loop] ? i + 1 : first);
    }
    return status == CSGM_OK && r->made != r->step_count ? CSGM_ERR_UNSUPPORTED : status;
}

/* The nodes first: those of the outline are its points. */
static csgm_status add_floor(roof *r)
{
    uint32_t *indices = NULL;
    size_t count = 0;
    bool ok = true;
    for (uint32_t i = 0; i < r->skeleton.node_count && ok; i++)
        ok = csg_triangles_add_point(&r->triangles, place(r, i));
    if (!ok)
        return CSGM_ERR_MEMORY;
    csgm_status status = csg_polygons_triangulate(r->outline, r->memory, &indices, &count);
    for (size_t i = 0; i + 2 < count && ok; i += 3)
        ok = csg_triangles_add(&r->triangles, indices[i], indices[i + 2], indices[i + 1]);
    csg_memory_release(r->memory, indices, count * sizeof *indices);
    return ok ? status : CSGM_ERR_MEMORY;
}

static csgm_status build(roof *r)
{
    size_t nodes = r->skeleton.node_count;
    size_t steps = r->outline->point_count + 2 * r->skeleton.arc_count;
    r->same = csg_memory_alloc(r->memory, nodes * sizeof *r->same);
    r->steps = csg_memory_alloc(r->memory, steps * sizeof *r->steps);
    r->border = csg_memory_alloc(r->memory, steps * sizeof *r->border);
    csgm_status status = CSGM_ERR_MEMORY;
    if (r->same && r->steps && r->border) {
        join_ends(r);
        collect_steps(r);
        status = add_floor(r);
    }
    if (status == CSGM_OK)
        status = add_faces(r);
    csg_memory_release(r->memory, r->same, nodes * sizeof *r->same);
    csg_memory_release(r->memory, r->steps, steps * sizeof *r->steps);
    csg_memory_release(r->memory, r->border, steps * sizeof *r->border);
    return status;
}

csg_node_id csg_solid_straight_roof(csg_solid_job *job, csg_outline *clean)
{
    csg_vec3 sides = csg_box_size(csg_outline_box(clean));
    roof r = {.memory = job->memory, .outline = clean, .size = fmax(sides.x, sides.y)};
    csgm_status status = csg_skeleton_make(clean, job->memory, &r.skeleton);
    csg_triangles_init(&r.triangles, job->memory);
    if (status == CSGM_OK && r.skeleton.node_count)
        status = build(&r);
    csg_skeleton_release(&r.skeleton);
    csg_outline_release(clean);
    if (status == CSGM_OK)
        return csg_solid_of_triangles(job, &r.triangles, NULL);
    csg_triangles_release(&r.triangles);
    if (status == CSGM_ERR_LIMIT)
        return csg_solid_failed(job, CSGM_ERR_SCENE,
                                "make a straight roof over so many corners that point inwards");
    return csg_solid_failed(job, status, "make a straight roof over this figure");
}
