/* SPDX-License-Identifier: MIT
 * See mesh_support.h.
 */
#include "mesh/mesh_support.h"

#include <string.h>

#include "scene/primitives/kinds.h"

static void note_finding(void *user, const csgm_diag *diag)
{
    mesh_case *c = user;
    c->findings++;
    c->last_code = diag->code;
    assert_true(strlen(diag->message) > 0);
}

void mesh_case_begin(mesh_case *c, uint32_t threads)
{
    memset(c, 0, sizeof *c);
    test_context_init(&c->context);
    c->context.diags.on_diag = note_finding;
    c->context.diags.user = c;
    c->context.isa = csg_cpu_best_isa(CSGM_ISA_AUTO);
    c->context.pool = csg_pool_create(&c->context.memory, threads);
    assert_non_null(c->context.pool);
    assert_int_equal(csg_build_begin(&c->builder, &c->context), CSGM_OK);
}

void mesh_case_compile(mesh_case *c, csg_node_id root)
{
    c->scene = test_seal(&c->builder, root);
    assert_int_equal(csg_field_compile(&c->context, c->scene, &c->field), CSGM_OK);
}

void mesh_case_end(mesh_case *c)
{
    csg_mesh_destroy(c->mesh);
    csg_field_destroy(c->field);
    csg_scene_destroy(c->scene);
    csg_pool_destroy(c->context.pool);
    test_context_end(&c->context);
}

csgm_mesh_options mesh_options(uint32_t resolution)
{
    return (csgm_mesh_options){.struct_size = sizeof(csgm_mesh_options),
                               .bounds = csg_box_empty(),
                               .resolution = resolution,
                               .normals = true,
                               .colors = true,
                               .prune = true};
}

csgm_status mesh_build(mesh_case *c, const csgm_mesh_options *options)
{
    csg_mesh_destroy(c->mesh);
    c->mesh = NULL;
    c->findings = 0;
    c->last_code = 0;
    c->context.diags.errors = c->context.diags.warnings = 0; /* the cap is not for tests */
    return csg_mesh_build(&c->context, c->field, options, &c->mesh, &c->stats);
}

static void assert_unit_normals(const csgm_mesh *mesh, const char *what)
{
    for (uint64_t i = 0; mesh->normals && i < mesh->vertex_count; i++) {
        const float *n = mesh->normals + 3 * i;
        float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        if (!(fabsf(square - 1) < 1e-5f))
            fail_msg("%s: normal %llu is (%g %g %g)", what, (unsigned long long)i, (double)n[0],
                     (double)n[1], (double)n[2]);
    }
}

void mesh_build_closed(mesh_case *c, const csgm_mesh_options *options, const char *what)
{
    if (mesh_build(c, options) != CSGM_OK)
        fail_msg("%s: no mesh", what);
    csgm_mesh_view view = csg_mesh_view(c->mesh);
    assert_int_equal(csg_mesh_inspect(&c->context, &view, 0, &c->check), CSGM_OK);
    const csgm_mesh_check *k = &c->check;
    const struct {
        const char *name;
        uint64_t count;
    } faults[] = {{"boundary edges", k->boundary_edges},
                  {"non-manifold edges", k->nonmanifold_edges},
                  {"misoriented edges", k->misoriented_edges},
                  {"non-manifold vertices", k->nonmanifold_vertices},
                  {"degenerate triangles", k->degenerate_triangles},
                  {"indices out of range", k->index_out_of_range},
                  {"unused vertices", k->unused_vertices}};
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
        if (faults[i].count)
            fail_msg("%s: %llu %s", what, (unsigned long long)faults[i].count, faults[i].name);
    assert_unit_normals(c->mesh, what);
}

csg_vec3 mesh_vertex(const mesh_case *c, uint64_t i)
{
    const float *p = c->mesh->positions + 3 * i;
    csg_vec3 at = {(double)p[0], (double)p[1], (double)p[2]};
    return csg_vec3_add(c->mesh->origin, at);
}

double mesh_largest_error(const mesh_case *c)
{
    double most = 0;
    for (uint64_t i = 0; i < c->mesh->vertex_count; i++)
        most = fmax(most, fabs(test_sample(c->scene, mesh_vertex(c, i)).value));
    return most;
}

void mesh_assert_same(const csgm_mesh *a, const csgm_mesh *b, const char *what)
{
    size_t vertices = a->vertex_count, triangles = a->triangle_count;
    if (vertices != b->vertex_count || triangles != b->triangle_count)
        fail_msg("%s: %zu vertices and %zu triangles, then %llu and %llu", what, vertices,
                 triangles, (unsigned long long)b->vertex_count,
                 (unsigned long long)b->triangle_count);
    if (memcmp(&a->origin, &b->origin, sizeof a->origin))
        fail_msg("%s: origins differ", what);
    assert_int_equal(a->normals != NULL, b->normals != NULL);
    assert_int_equal(a->colors != NULL, b->colors != NULL);
    if (triangles && memcmp(a->indices, b->indices, 12 * triangles))
        fail_msg("%s: indices differ", what);
    if (vertices && memcmp(a->positions, b->positions, 12 * vertices))
        fail_msg("%s: positions differ", what);
    if (a->normals && memcmp(a->normals, b->normals, 12 * vertices))
        fail_msg("%s: normals differ", what);
    if (a->colors && memcmp(a->colors, b->colors, 4 * vertices))
        fail_msg("%s: colours differ", what);
}

void mesh_assert_same_by(const mesh_case *a, csg_node_id make(mesh_case *c),
                         const csgm_mesh_options *options, uint32_t threads, csgm_isa isa)
{
    mesh_case b;
    mesh_case_begin(&b, threads);
    if (isa != CSGM_ISA_AUTO)
        b.context.isa = csg_cpu_best_isa(isa);
    mesh_case_compile(&b, make(&b));
    mesh_build_closed(&b, options, "threads");
    mesh_assert_same(a->mesh, b.mesh, "threads");
    mesh_case_end(&b);
}

double mesh_beyond_hull(const csg_cone_balls *balls, csg_vec3 g, csg_vec3 u)
{
    double most = -INFINITY;
    for (uint32_t i = 0; i < balls->count; i++) {
        const csg_cone_ball *ball = &balls->items[i];
        most = fmax(most, u.x * ball->at[0] + u.y * ball->at[1] + u.z * ball->at[2] + ball->spread);
    }
    return csg_vec3_dot(g, u) - most;
}

csg_node_id make_sphere(mesh_case *c, double r)
{
    return csg_build_primitive(&c->builder, CSG_NODE_SPHERE, &r, NOWHERE);
}

csg_node_id make_box(mesh_case *c, double hx, double hy, double hz)
{
    return csg_build_primitive(&c->builder, CSG_NODE_BOX, (double[]){hx, hy, hz, 0}, NOWHERE);
}

csg_node_id make_cylinder(mesh_case *c, double r, double half_height)
{
    return csg_build_primitive(&c->builder, CSG_NODE_FRUSTUM, (double[]){r, r, half_height, 0},
                               NOWHERE);
}

csg_node_id make_half_space(mesh_case *c, double nx, double ny, double nz, double d)
{
    return csg_build_primitive(&c->builder, CSG_NODE_PLANE, (double[]){nx, ny, nz, d}, NOWHERE);
}

csg_node_id moved(mesh_case *c, csg_node_id node, double x, double y, double z)
{
    csg_affine place = csg_affine_translate(csg_vec3_make(x, y, z));
    return csg_build_transform(&c->builder, &place, node, NOWHERE);
}

csg_node_id turned(mesh_case *c, csg_node_id node, double angle_deg, csg_vec3 axis)
{
    csg_affine place = csg_affine_rotate(angle_deg, axis);
    return csg_build_transform(&c->builder, &place, node, NOWHERE);
}

csg_node_id joined(mesh_case *c, csg_node_kind kind, csg_blend blend, csg_node_id a, csg_node_id b)
{
    return csg_build_operator(&c->builder, kind, blend, (csg_node_id[]){a, b}, 2, NOWHERE);
}

csg_node_id make_any_primitive(mesh_case *c, int kind, csg_random *random)
{
    double a = csg_random_uniform(random, 0.3, 1), b = csg_random_uniform(random, 0.3, 1);
    double e = csg_random_uniform(random, 0.3, 1);
    double r = kind % 2 ? 0 : 0.2 * fmin(a, fmin(b, e));
    csg_scene_builder *build = &c->builder;
    switch (kind % 9) {
    case 0:
        return csg_build_primitive(build, CSG_NODE_SPHERE, (double[]){a}, NOWHERE);
    case 1:
    case 2:
        return csg_build_primitive(build, CSG_NODE_BOX, (double[]){a, b, e, r}, NOWHERE);
    case 3:
    case 4:
        return csg_build_primitive(build, CSG_NODE_FRUSTUM, (double[]){a, b, e, r}, NOWHERE);
    case 5:
        return csg_build_primitive(build, CSG_NODE_FRUSTUM, (double[]){a, 0, e, 0}, NOWHERE);
    case 6:
        return csg_build_primitive(build, CSG_NODE_CAPSULE, (double[]){1.5, a * 0.5, b * 0.5},
                                   NOWHERE);
    case 7:
        return csg_build_primitive(build, CSG_NODE_TORUS, (double[]){a + 0.3, 0.25, 180}, NOWHERE);
    default:
        return csg_build_primitive(build, CSG_NODE_ELLIPSOID, (double[]){a, b, e}, NOWHERE);
    }
}

csg_node_id posed_anyhow(mesh_case *c, csg_node_id node, csg_random *random)
{
    node = turned(c, node, csg_random_uniform(random, 0, 360), test_direction(random));
    return moved(c, node, csg_random_uniform(random, -0.5, 0.5),
                 csg_random_uniform(random, -0.5, 0.5), csg_random_uniform(random, -0.5, 0.5));
}

csg_blend round_blend(double width)
{
    return csg_blend_round(width);
}
