/* SPDX-License-Identifier: MIT
 * Parts of closed meshes, as closed meshes: whatever triangles are taken, a corner table holds
 * them.
 */
#include <stdlib.h>
#include <string.h>

#include "mesh/mesh_support.h"
#include "mesh/remesh/close.h"
#include "scene/primitives/kinds.h"

static void assert_closed(const csgm_mesh *part, mesh_case *c, unsigned *parted, unsigned *fans)
{
    csg_closed_mesh closed;
    csg_corners corners;
    assert_int_equal(csg_mesh_close(part, &closed), CSGM_OK);
    const csgm_mesh *mesh = closed.mesh;
    assert_int_equal(mesh->triangle_count, part->triangle_count + closed.closing);
    assert_int_equal(csg_corners_make(&corners, &c->context.memory, mesh->indices,
                                      mesh->triangle_count, mesh->vertex_count),
                     CSG_CORNERS_MADE);
    csg_corners_release(&corners);
    for (uint64_t i = 0; i < 3 * part->triangle_count; i++) {
        uint32_t v = mesh->indices[3 * (uint64_t)closed.closing + i];
        assert_int_equal(closed.original[v], part->indices[i]);
        assert_memory_equal(mesh->positions + 3 * (size_t)v,
                            part->positions + 3 * (size_t)part->indices[i], 3 * sizeof(float));
        *parted += v >= part->vertex_count;
    }
    for (uint64_t i = 0; i < 3 * (uint64_t)closed.closing; i++) {
        uint32_t v = mesh->indices[i];
        bool is_middle = closed.original[v] == CSG_CORNER_NONE;
        assert_int_equal(closed.at_border[v], !is_middle);
        *fans += is_middle;
    }
    csg_closed_mesh_release(&closed);
}

/* Triangles by chance, those on one side of a plane, none, all. */
static void test_parts(void **state)
{
    enum { PARTS = 60 };
    unsigned parted = 0, fans = 0;
    mesh_case c;
    csg_random random = {7};
    mesh_case_begin(&c, 1);
    csg_node_id ring =
        csg_build_primitive(&c.builder, CSG_NODE_TORUS, (double[]){1, 0.3, 180}, NOWHERE);
    mesh_case_compile(&c, ring);
    csgm_mesh_options options = mesh_options(18);
    mesh_build_closed(&c, &options, "torus");
    csgm_mesh part = *c.mesh;
    part.normals = NULL;
    part.indices = malloc(3 * (size_t)c.mesh->triangle_count * sizeof *part.indices);
    assert_non_null(part.indices);
    for (unsigned i = 0; i < PARTS; i++) {
        uint32_t share = i * 100 / (PARTS - 1);
        part.triangle_count = 0;
        for (uint64_t t = 0; t < c.mesh->triangle_count; t++) {
            const uint32_t *v = c.mesh->indices + 3 * t;
            bool beside = mesh_vertex(&c, v[0]).x + mesh_vertex(&c, v[1]).z > 0.1 * (i % 7);
            bool chosen = i % 2 ? csg_random_below(&random, 100) < share : beside;
            if (chosen)
                memcpy(part.indices + 3 * part.triangle_count++, v, 3 * sizeof *v);
        }
        assert_closed(&part, &c, &parted, &fans);
    }
    free(part.indices);
    assert_closed(c.mesh, &c, &parted, &fans);
    assert_true(parted > 100 && fans > 1000);
    mesh_case_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_parts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
