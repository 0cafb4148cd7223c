/* SPDX-License-Identifier: MIT
 * The search for missed parts (mesh/distance/missed.h) of a mesh that was changed here and there:
 * what it takes from the search before is what it would find.
 */
#include <stdlib.h>
#include <string.h>

#include "mesh/distance/missed.h"
#include "mesh/mesh_support.h"
#include "mesh/pipeline/workers.h"

enum { CELLS = 20 };
static const double ERROR = 0.2; /* of a cell */

/* What a search is made with, but for the mesh. */
typedef struct bench {
    mesh_case c;
    csgm_mesh_options options;
    csg_mesh_input input;
    csg_mesh_workers workers;
    csg_mesh_watch watch;
    double error;
} bench;

static void begin_bench(bench *b, csg_random *random, int kind)
{
    mesh_case *c = &b->c;
    memset(b, 0, sizeof *b);
    mesh_case_begin(c, 2);
    csg_node_kind how = kind % 2 ? CSG_NODE_UNION : CSG_NODE_DIFFERENCE;
    csg_blend blend = kind % 3 ? ROUND(0.1) : SHARP;
    csg_node_id one = posed_anyhow(c, make_any_primitive(c, kind, random), random);
    csg_node_id other = posed_anyhow(c, make_any_primitive(c, kind / 2, random), random);
    mesh_case_compile(c, joined(c, how, blend, one, other));
    b->options = mesh_options(CELLS);
    b->options.normals = false;
    b->input = (csg_mesh_input){.context = &c->context, .options = &b->options, .field = c->field};
    csg_mesh_input_watch(&b->input, 0, &b->watch);
    assert_int_equal(csg_mesh_input_complete(&b->input), CSGM_OK);
    assert_int_equal(csg_mesh_workers_create(&b->workers, &b->input), CSGM_OK);
    assert_int_equal(mesh_build(c, &b->options), CSGM_OK);
    b->error = ERROR * b->input.lattice.cell_size;
}

static void end_bench(bench *b)
{
    csg_mesh_workers_release(&b->workers);
    csg_mesh_input_release(&b->input);
    mesh_case_end(&b->c);
}

/* The mesh of cells, with the vertices around one of them moved by so much. */
static csgm_mesh *mesh_with_bump(const bench *b, uint64_t vertex, double height)
{
    const csgm_mesh *from = b->c.mesh;
    csgm_mesh *mesh;
    double reach = 2 * b->input.lattice.cell_size;
    assert_int_equal(csg_mesh_create(from->context, from->vertex_count, from->triangle_count, false,
                                     false, &mesh),
                     CSGM_OK);
    mesh->origin = from->origin;
    memcpy(mesh->indices, from->indices, 3 * from->triangle_count * sizeof *from->indices);
    for (uint64_t v = 0; v < from->vertex_count; v++) {
        csg_vec3 at = csg_vec3_from_floats(from->positions + 3 * v);
        csg_vec3 off = csg_vec3_sub(at, csg_vec3_from_floats(from->positions + 3 * vertex));
        at.x += csg_vec3_norm(off) < reach ? height : 0;
        csg_vec3_to_floats(mesh->positions + 3 * v, at);
    }
    return mesh;
}

/* keeps: what the search gave is put into *before. */
static csg_missed find_missed(bench *b, csgm_mesh *mesh, csg_missed_before *before, bool keeps)
{
    csg_remesh r;
    csg_missed missed;
    uint8_t *kinds = calloc(1, (size_t)mesh->vertex_count);
    const csg_remesh_origin origin = {.kinds = kinds};
    assert_non_null(kinds);
    assert_int_equal(csg_remesh_begin(&r, mesh, &origin, &b->workers.marching, &b->watch), CSGM_OK);
    assert_int_equal(csg_missed_find(&r, b->error, before, keeps, &missed), CSGM_OK);
    if (keeps)
        csg_missed_keep(&r, &missed, before);
    csg_mesh_destroy(r.mesh);
    csg_remesh_end(&r);
    free(kinds);
    return missed;
}

/* The nearest triangle may be another one of those that meet in the place that is nearest: places
 * are kept as floats. */
static bool are_equal(const csg_missed *a, const csg_missed *b)
{
    const csg_missed_distances *p = &a->distances, *q = &b->distances;
    bool same = a->count == b->count && a->unfinished == b->unfinished;
    for (size_t i = 0; i < a->count && same; i++)
        same = !memcmp(a->points[i].at, b->points[i].at, sizeof a->points[i].at);
    return same && p->unlisted == q->unlisted && fabs(p->farthest - q->farthest) < 1e-6;
}

/* What is kept is taken: places that are struck out of it are not found again, but where the mesh
 * has changed. */
static bool is_taken(bench *b, uint64_t vertex, csg_missed_before *before, const csg_missed *whole)
{
    for (size_t i = 0; i < before->missed.stretch_count; i++)
        before->missed.stretches[i].count = 0;
    csg_missed found = find_missed(b, mesh_with_bump(b, vertex, 3 * b->error), before, false);
    bool is_less = found.count < whole->count;
    csg_missed_release(&found, &b->c.context.memory);
    return is_less;
}

static void what_is_kept_is_what_would_be_found(void **state)
{
    (void)state;
    csg_random random = {.state = 77};
    int different = 0, taken = 0, tried = 0;
    for (int i = 0; i < 18; i++) {
        bench b;
        csg_missed_before none = {0}, before = {0};
        begin_bench(&b, &random, i);
        csg_memory *memory = &b.c.context.memory;
        if (b.c.mesh->vertex_count) {
            uint64_t vertex = csg_random_next(&random) % b.c.mesh->vertex_count;
            find_missed(&b, mesh_with_bump(&b, vertex, 0), &before, true);
            csg_missed again =
                find_missed(&b, mesh_with_bump(&b, vertex, 3 * b.error), &before, false);
            csg_missed whole =
                find_missed(&b, mesh_with_bump(&b, vertex, 3 * b.error), &none, false);
            if (!are_equal(&again, &whole))
                fail_msg("scene %d: %zu places and not %zu, the farthest %g and not %g", i,
                         again.count, whole.count, again.distances.farthest,
                         whole.distances.farthest);
            tried++;
            different += !are_equal(&before.missed, &whole);
            taken += is_taken(&b, vertex, &before, &whole);
            csg_missed_release(&again, memory);
            csg_missed_release(&whole, memory);
        }
        csg_missed_before_release(&before, memory);
        end_bench(&b);
    }
    assert_true(tried >= 12 && 2 * different > tried && 2 * taken > tried);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_kept_is_what_would_be_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
