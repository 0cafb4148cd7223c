/* SPDX-License-Identifier: MIT
 * See own_support.h.
 */
#include "mesh/own_support.h"

#include "mesh/pipeline/own.h"
#include "shape/plane/region.h"
#include "shape/solid_support.h"

#include <math.h>
#include <stdlib.h>

csg_node_id shape_of(mesh_case *c, const csg_triangles *triangles)
{
    csg_shape *shape;
    csg_repairs repairs;
    assert_int_equal(csg_polyhedron_create(&c->context.memory, triangles, &repairs, &shape),
                     CSGM_OK);
    return csg_build_shape(&c->builder, shape, NOWHERE);
}

csg_node_id make_ball(mesh_case *c, csg_vec3 center, double radius, uint32_t columns, double bumps)
{
    csg_triangles triangles;
    csg_triangles_init(&triangles, &c->context.memory);
    solid_add_ball(&triangles, center, radius, columns, columns, bumps);
    csg_node_id node = shape_of(c, &triangles);
    csg_triangles_release(&triangles);
    return node;
}

csgm_mesh_options plain(void)
{
    return mesh_options(0);
}

/* Whether they are taken; if not, nothing is meshed. */
bool is_taken(mesh_case *c, const csgm_mesh_options *options)
{
    csg_mesh_destroy(c->mesh);
    c->mesh = NULL;
    assert_int_equal(csg_mesh_build_own(&c->context, c->field, options, NULL, &c->mesh, &c->stats),
                     CSGM_OK);
    return c->mesh != NULL;
}

uint64_t own_of(mesh_case *c, const csgm_mesh_options *options)
{
    assert_int_equal(mesh_build(c, options), CSGM_OK);
    return c->stats.own_triangles;
}

/* Where the solid is, the mesh winds around once, elsewhere never, but for places so near to its
 * surface. */
void assert_winds_beyond(const mesh_case *c, csg_random *random, double near)
{
    const csgm_mesh *mesh = c->mesh;
    csg_triangles t = {.points = malloc(mesh->vertex_count * sizeof(csg_vec3)),
                       .point_count = mesh->vertex_count,
                       .corners = (uint32_t(*)[3])mesh->indices,
                       .count = mesh->triangle_count};
    for (uint64_t i = 0; i < mesh->vertex_count; i++)
        t.points[i] = mesh_vertex(c, i);
    for (int i = 0; i < 100; i++) {
        csg_vec3 p =
            mesh_vertex(c, (uint64_t)csg_random_uniform(random, 0, (double)mesh->vertex_count - 1));
        p = csg_vec3_add(p, solid_random_point(random, 0.1));
        double f = test_sample(c->scene, p).value;
        if (fabs(f) > near)
            assert_true(fabs(solid_winding(&t, p) - (f > 0)) < 1e-3);
    }
    free(t.points);
}

void assert_winds_around(const mesh_case *c, csg_random *random)
{
    assert_winds_beyond(c, random, 1e-5);
}

csg_node_id region_of(mesh_case *c, csg_outline *outline)
{
    csg_shape *shape;
    assert_int_equal(csg_region_create(&c->context.memory, outline, &shape), CSGM_OK);
    csg_outline_release(outline);
    return csg_build_shape(&c->builder, shape, NOWHERE);
}

/* Stars with holes in rows. */

void own_fail_each_allocation(csg_node_id make(mesh_case *c), double tolerance, long step)
{
    mesh_case c;
    failing f = {0};
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, make(&c));
    uint64_t before = atomic_load(&c.context.memory.used_bytes);
    csgm_allocator original = c.context.memory.allocator;
    c.context.memory.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
    csgm_mesh_options options = plain();
    options.quality = CSGM_QUALITY_DRAFT;
    options.tolerance = tolerance;
    options.normals = CSGM_NORMALS_CREASE;
    csgm_status status = CSGM_ERR_MEMORY;
    long n = 0;
    while (status == CSGM_ERR_MEMORY) {
        f.left = n;
        n += step;
        status = mesh_build(&c, &options);
        assert_int_equal(c.findings, status == CSGM_OK ? 0 : 1);
        csg_mesh_destroy(c.mesh);
        c.mesh = NULL;
        assert_int_equal(atomic_load(&c.context.memory.used_bytes), before);
    }
    assert_int_equal(status, CSGM_OK);
    assert_true(n > 15 * step);
    c.context.memory.allocator = original;
    mesh_case_end(&c);
}
