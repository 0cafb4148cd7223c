/* SPDX-License-Identifier: MIT
 * 3MF -> mesh: the items to build, each object's mesh put in its place, components within
 * components with a stack of their own. Each item is a part with its object's name. Lengths become
 * millimetres; those of csgmesh's own files stay the numbers that they are. A vertex has one
 * colour, that of the first triangle with one.
 */
#include <math.h>
#include <stdlib.h>

#include "io/threemf/threemf.h"
#include "io/units.h"

enum {
    MOST_DEPTH = 32,      /* of components in components */
    MOST_PLACED = 1 << 20 /* objects, so that few bytes do not place them without end */
};

typedef struct placed {
    const csg_3mf_object *object;
    double transform[12];
    int depth;
} placed;

typedef struct reading {
    csg_3mf *m;
    csg_mesh_builder *builder;
    const csg_3mf_object **sorted; /* by file and id */
    placed *stack;
    size_t stack_count, stack_room;
    uint64_t placed_count;
    double enlarge; /* what coordinates are multiplied by */
} reading;

static int compare(uint32_t file_a, uint32_t id_a, uint32_t file_b, uint32_t id_b)
{
    if (file_a != file_b)
        return file_a < file_b ? -1 : 1;
    return id_a < id_b ? -1 : id_a > id_b;
}

static int compare_objects(const void *a, const void *b)
{
    const csg_3mf_object *p, *q;
    memcpy(&p, a, sizeof p);
    memcpy(&q, b, sizeof q);
    return compare(p->file, p->id, q->file, q->id);
}

static csgm_status sort_objects(reading *r)
{
    csg_3mf *m = r->m;
    if (!m->object_count)
        return CSGM_OK;
    r->sorted = csg_memory_alloc(&m->input->context->memory, m->object_count * sizeof *r->sorted);
    if (!r->sorted)
        return csg_context_no_memory(m->input->context);
    for (size_t i = 0; i < m->object_count; i++)
        r->sorted[i] = &m->objects[i];
    qsort(r->sorted, m->object_count, sizeof *r->sorted, compare_objects);
    for (size_t i = 1; i < m->object_count; i++)
        if (compare_objects(&r->sorted[i - 1], &r->sorted[i]) == 0)
            return csg_read_broken(m->input, 0, "two objects have the id %u", r->sorted[i]->id);
    return CSGM_OK;
}

static const csg_3mf_object *find_object(const reading *r, const csg_3mf_reference *reference)
{
    size_t low = 0, high = r->m->object_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const csg_3mf_object *object = r->sorted[middle];
        int order = compare(object->file, object->id, reference->file, reference->id);
        if (order == 0)
            return object;
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

/* First b, then a; rows of [m | t]. */
static void multiply(const double a[12], const double b[12], double out[12])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++)
            out[4 * r + c] = a[4 * r] * b[c] + a[4 * r + 1] * b[4 + c] + a[4 * r + 2] * b[8 + c] +
                             (c == 3 ? a[4 * r + 3] : 0);
}

static csgm_status push_component(reading *r, const csg_3mf_reference *reference,
                                  const double outer[12], int depth)
{
    csg_input *input = r->m->input;
    const csg_3mf_object *object = find_object(r, reference);
    if (!object)
        return csg_read_broken(input, 0, "there is no object with the id %u", reference->id);
    if (depth > MOST_DEPTH)
        return csg_read_broken(input, 0, "object %u is its own component, or nested too deeply",
                               reference->id);
    if (++r->placed_count > MOST_PLACED)
        return csg_read_unsupported(input, "more than %d objects in all", MOST_PLACED);
    if (!csg_memory_reserve(&input->context->memory, (void **)&r->stack, &r->stack_room,
                            r->stack_count + 1, sizeof *r->stack))
        return csg_context_no_memory(input->context);
    placed *top = &r->stack[r->stack_count++];
    *top = (placed){.object = object, .depth = depth};
    if (outer)
        multiply(outer, reference->transform, top->transform);
    else
        memcpy(top->transform, reference->transform, sizeof top->transform);
    return CSGM_OK;
}

static double determinant(const double m[12])
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

/* A transform that mirrors turns the triangles around. */
static csgm_status add_mesh(reading *r, const placed *place)
{
    const csg_3mf *m = r->m;
    const csg_3mf_object *object = place->object;
    uint64_t first = r->builder->vertex_count;
    bool mirrored = determinant(place->transform) < 0;
    if (first + object->vertex_count > UINT32_MAX)
        return csg_read_unsupported(m->input, "more than 4294967295 vertices in all");
    for (size_t i = 0; i < object->vertex_count && !r->builder->failed; i++) {
        const csg_3mf_vertex *vertex = &m->vertices[object->first_vertex + i];
        double at[3];
        for (int k = 0; k < 3; k++) {
            const double *row = place->transform + 4 * k;
            at[k] = r->enlarge * (row[0] * vertex->at[0] + row[1] * vertex->at[1] +
                                  row[2] * vertex->at[2] + row[3] + 0.0);
            if (!isfinite(at[k]))
                return csg_read_broken(m->input, 0, "a vertex is moved beyond all numbers");
        }
        csg_builder_vertex(r->builder, at, NULL, m->colored ? vertex->color : NULL);
    }
    for (size_t i = 0; i < object->triangle_count && !r->builder->failed; i++) {
        const uint32_t *corner = m->triangles + 3 * (object->first_triangle + i);
        csg_builder_triangle(r->builder, (uint32_t)first + corner[0],
                             (uint32_t)first + corner[mirrored ? 2 : 1],
                             (uint32_t)first + corner[mirrored ? 1 : 2]);
    }
    return r->builder->failed ? csg_builder_why_failed(r->builder) : CSGM_OK;
}

/* Everything on the stack and below it; components come out in their order. */
static csgm_status unfold(reading *r)
{
    csgm_status status = CSGM_OK;
    while (!status && r->stack_count) {
        placed place = r->stack[--r->stack_count];
        status = add_mesh(r, &place);
        for (size_t i = place.object->component_count; i-- > 0 && !status;)
            status = push_component(r, &r->m->components[place.object->first_component + i],
                                    place.transform, place.depth + 1);
    }
    return status;
}

static void note_unit(reading *r)
{
    const csg_3mf *m = r->m;
    r->enlarge = m->ours ? 1 : m->unit_mm;
    csg_builder_unit(r->builder, m->ours ? csg_unit_of_mm(m->unit_mm) : CSGM_UNIT_MM);
    if (m->has_pictures)
        csg_builder_leave_out(r->builder, "textures");
}

csgm_status csg_3mf_read(csg_input *input, csg_mesh_builder *builder)
{
    csg_3mf model;
    reading r = {.m = &model, .builder = builder};
    csg_memory *memory = &input->context->memory;
    csgm_status status = csg_3mf_load(&model, input);
    note_unit(&r);
    if (!status)
        status = sort_objects(&r);
    for (size_t i = 0; i < model.item_count && !status; i++) {
        const csg_3mf_object *object = find_object(&r, &model.items[i]);
        if (!csg_builder_part(builder, object ? object->name : NULL))
            status = csg_context_no_memory(input->context);
        else
            status = push_component(&r, &model.items[i], NULL, 0);
        if (!status)
            status = unfold(&r);
    }
    csg_memory_release(memory, r.stack, r.stack_room * sizeof *r.stack);
    csg_memory_release(memory, r.sorted, model.object_count * sizeof *r.sorted);
    csg_3mf_release(&model);
    return status;
}
