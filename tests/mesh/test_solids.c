/* SPDX-License-Identifier: MIT
 * Meshes of solids that are known in closed form: volumes within 0.1 % at 256 cells, vertices on
 * exact surfaces, fillets on their arc.
 */
#include "base/mesh_codes.h"
#include "mesh/mesh_support.h"
#include "scene/primitives/kinds.h"

#define PI 3.14159265358979323846

typedef csg_node_id make_fn(mesh_case *c);

static csg_node_id primitive(mesh_case *c, csg_primitive_kind kind, double a, double b, double d)
{
    return csg_build_primitive(&c->builder, kind, (double[]){a, b, d, 0}, NOWHERE);
}

static csg_node_id sphere(mesh_case *c)
{
    return moved(c, make_sphere(c, 1), 0.1, -0.2, 0.3);
}
static csg_node_id box(mesh_case *c)
{
    return make_box(c, 1, 0.7, 0.4);
}
static csg_node_id turned_box(mesh_case *c)
{
    return turned(c, make_box(c, 1, 0.7, 0.4), 33, csg_vec3_make(0.6, 0, 0.8));
}
static csg_node_id frustum(mesh_case *c)
{
    return primitive(c, CSG_NODE_FRUSTUM, 1, 0.4, 0.8);
}
static csg_node_id cone(mesh_case *c)
{
    return primitive(c, CSG_NODE_FRUSTUM, 0.9, 0, 0.8);
}
static csg_node_id torus(mesh_case *c)
{
    return turned(c, primitive(c, CSG_NODE_TORUS, 1, 0.35, 180), 20, csg_vec3_make(1, 0, 0));
}
static csg_node_id capsule(mesh_case *c)
{
    return primitive(c, CSG_NODE_CAPSULE, 1.5, 0.5, 0.5);
}
static csg_node_id ellipsoid(mesh_case *c)
{
    return primitive(c, CSG_NODE_ELLIPSOID, 0.5, 1, 0.2);
}
static csg_node_id scaled_sphere(mesh_case *c)
{
    csg_affine place = csg_affine_scale(csg_vec3_make(0.5, 1, 0.25));
    return csg_build_transform(&c->builder, &place, make_sphere(c, 1), NOWHERE);
}
/* A hole through the middle of a ball: pi h^3 / 6, h the height left over. */
static csg_node_id napkin_ring(mesh_case *c)
{
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_sphere(c, 1), make_cylinder(c, 0.6, 2));
}
static csg_node_id two_cylinders(mesh_case *c)
{
    csg_node_id across = turned(c, make_cylinder(c, 1, 2), 90, csg_vec3_make(0, 1, 0));
    return joined(c, CSG_NODE_INTERSECTION, SHARP, make_cylinder(c, 1, 2), across);
}
static csg_node_id three_cylinders(mesh_case *c)
{
    csg_node_id third = turned(c, make_cylinder(c, 1, 2), 90, csg_vec3_make(1, 0, 0));
    return joined(c, CSG_NODE_INTERSECTION, SHARP, two_cylinders(c), third);
}

/* ---- volumes -------------------------------------------------------------------------------- */

static const struct {
    const char *name;
    make_fn *make;
    double volume;
    int euler;
    bool is_distance; /* the reference is the distance to the surface */
} solids[] = {
    {"sphere", sphere, 4 * PI / 3, 2, true},
    {"box", box, 8 * 1 * 0.7 * 0.4, 2, true},
    {"turned box", turned_box, 8 * 1 * 0.7 * 0.4, 2, true},
    {"cone frustum", frustum, PI * 1.6 / 3 * (1 + 0.4 + 0.16), 2, true},
    {"cone", cone, PI * 1.6 / 3 * 0.81, 2, true},
    {"torus", torus, 2 * PI *PI * 0.35 * 0.35, 0, true},
    {"capsule", capsule, PI * 0.25 * 1.5 + 4 * PI / 3 * 0.125, 2, true},
    {"ellipsoid", ellipsoid, 4 * PI / 3 * 0.1, 2, true},
    {"scaled sphere", scaled_sphere, 4 * PI / 3 * 0.125, 2, false},
    {"napkin ring", napkin_ring, PI * 1.6 * 1.6 * 1.6 / 6, 0, false},
    {"two cylinders", two_cylinders, 16.0 / 3, 2, false},
    {"three cylinders", three_cylinders, 8 * (2 - 1.41421356237309504880), 2, false},
};

static void test_volumes(void **state)
{
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, solids[i].make(&c));
        csgm_mesh_options options = mesh_options(256);
        mesh_build_closed(&c, &options, solids[i].name);
        if (!(fabs(c.check.volume / solids[i].volume - 1) < 1e-3))
            fail_msg("%s: volume %.9g, not %.9g", solids[i].name, c.check.volume, solids[i].volume);
        assert_int_equal(c.check.euler, solids[i].euler);
        assert_int_equal(c.check.components, 1);
        assert_int_equal(c.findings, 0);
        mesh_case_end(&c);
    }
}

/* ---- vertices -------------------------------------------------------------------------------- */

/* Normals are minus the gradient; apexes have the mean of their sheets'. */
static void assert_normals_outward(const mesh_case *c, const char *what)
{
    uint64_t agree = 0, apexes = c->stats.feature_vertices;
    for (uint64_t i = 0; i < c->mesh->vertex_count; i++) {
        csg_vec3 g = test_sample(c->scene, mesh_vertex(c, i)).gradient;
        const float *n = c->mesh->normals + 3 * i;
        csg_vec3 normal = {(double)n[0], (double)n[1], (double)n[2]};
        agree += csg_vec3_dot(normal, csg_vec3_normalize(g)) < -0.999;
    }
    if ((double)agree < 0.99 * (double)(c->mesh->vertex_count - apexes))
        fail_msg("%s: only %llu of %llu normals point outwards", what, (unsigned long long)agree,
                 (unsigned long long)c->mesh->vertex_count);
}

static void test_vertices(void **state)
{
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, solids[i].make(&c));
        csgm_mesh_options options = mesh_options(64);
        mesh_build_closed(&c, &options, solids[i].name);
        double error = mesh_largest_error(&c), most = csg_box_longest_side(c.check.bounds);
        if (!(error < 2e-5 * most)) /* a thousandth of a cell: where a crease stays smooth */
            fail_msg("%s: a vertex is %g off", solids[i].name, error);
        assert_normals_outward(&c, solids[i].name);
        mesh_case_end(&c);
    }
}

/* The reference knows where a cylinder is; a ball of unit radius needs no reference. */
static void test_sphere_by_hand(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, sphere(&c));
    csgm_mesh_options options = mesh_options(100);
    mesh_build_closed(&c, &options, "sphere");
    assert_null(c.mesh->colors); /* there are none in the scene */
    csg_vec3 center = {0.1, -0.2, 0.3};
    for (uint64_t i = 0; i < c.mesh->vertex_count; i++) {
        csg_vec3 out = csg_vec3_sub(mesh_vertex(&c, i), center);
        test_near(csg_vec3_norm(out), 1, 1e-5);
        const float *n = c.mesh->normals + 3 * i;
        csg_vec3 normal = {(double)n[0], (double)n[1], (double)n[2]};
        test_near_vec3(normal, out, 1e-4);
    }
    assert_true(c.mesh->vertex_count > 10000);
    mesh_case_end(&c);
}

/* A ball under unequal scales: its field is no distance, so measure by hand: in the ball's own
 * frame, over the length of the gradient. */
static void test_scaled_sphere_by_hand(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    csg_vec3 s = {0.5, 1, 0.25};
    mesh_case_compile(&c, scaled_sphere(&c));
    csgm_mesh_options options = mesh_options(100);
    mesh_build_closed(&c, &options, "scaled sphere");
    for (uint64_t i = 0; i < c.mesh->vertex_count; i++) {
        csg_vec3 p = mesh_vertex(&c, i), q = {p.x / s.x, p.y / s.y, p.z / s.z};
        csg_vec3 out = {q.x / s.x, q.y / s.y, q.z / s.z};
        double distance = (csg_vec3_norm(q) - 1) * csg_vec3_norm(q) / csg_vec3_norm(out);
        test_near(distance, 0, 1e-5 * 2);
        const float *n = c.mesh->normals + 3 * i;
        csg_vec3 normal = {(double)n[0], (double)n[1], (double)n[2]};
        test_near_vec3(normal, csg_vec3_normalize(out), 1e-4);
    }
    mesh_case_end(&c);
}

/* ---- fillets --------------------------------------------------------------------------------- */

/* Two half-spaces at a right angle, joined with round(r): an arc of radius r about (s, s, z), s = r
 * in the corner of a union, -r on the edge of an intersection. */
static void check_fillet(csg_node_kind kind, double r)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    csg_node_id a = make_half_space(&c, 1, 0, 0, 0), b = make_half_space(&c, 0, 1, 0, 0);
    mesh_case_compile(&c, joined(&c, kind, ROUND(r), a, b));
    csgm_mesh_options options = mesh_options(64);
    options.bounds = (csg_box){{-1, -1, -1}, {1, 1, 1}};
    mesh_build_closed(&c, &options, "fillet");
    assert_int_equal(c.last_code, CSG_DIAG_CUT_BY_BOUNDS);
    double turn = kind == CSG_NODE_UNION ? 1 : -1;
    size_t on_arc = 0;
    for (uint64_t i = 0; i < c.mesh->vertex_count; i++) {
        csg_vec3 p = mesh_vertex(&c, i);
        double x = turn * p.x, y = turn * p.y;
        if (!(x > 0 && x < r && y > 0 && y < r) || fabs(p.z) > 0.99)
            continue;
        test_near(hypot(x - r, y - r), r, 1e-4 * r);
        on_arc++;
    }
    assert_true(on_arc > 300);
    /* A square's corner less a quarter disc is filled, or cut away. */
    double moved_area = r * r * (1 - PI / 4);
    double area = kind == CSG_NODE_UNION ? 3 + moved_area : 1 - moved_area;
    test_near(c.check.volume, 2 * area, 2e-3 * 2 * area);
    mesh_case_end(&c);
}

static void test_fillets(void **state)
{
    check_fillet(CSG_NODE_UNION, 0.5);
    check_fillet(CSG_NODE_UNION, 0.2);
    check_fillet(CSG_NODE_INTERSECTION, 0.5);
}

/* ---- colours --------------------------------------------------------------------------------- */

static void test_colors(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    csg_node_id red = csg_build_color(&c.builder, (csg_color){1, 0, 0, 1},
                                      moved(&c, make_sphere(&c, 0.5), -0.4, 0, 0), NOWHERE);
    csg_node_id blue = csg_build_color(&c.builder, (csg_color){0, 0, 1, 1},
                                       moved(&c, make_sphere(&c, 0.5), 0.4, 0, 0), NOWHERE);
    mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, ROUND(0.3), red, blue));
    csgm_mesh_options options = mesh_options(64);
    mesh_build_closed(&c, &options, "colours");
    assert_non_null(c.mesh->colors);
    size_t mixed = 0;
    for (uint64_t i = 0; i < c.mesh->vertex_count; i++) {
        const uint8_t *rgba = c.mesh->colors + 4 * i;
        double x = mesh_vertex(&c, i).x;
        assert_in_range(rgba[0] + rgba[2], 253, 257); /* shares of one */
        assert_int_equal(rgba[1], 0);
        assert_int_equal(rgba[3], 255);
        if (x < -0.4)
            assert_int_equal(rgba[0], 255);
        if (x > 0.4)
            assert_int_equal(rgba[2], 255);
        if (fabs(x) < 0.005)
            assert_in_range(rgba[0], 118, 138);
        mixed += rgba[0] > 0 && rgba[2] > 0;
    }
    assert_true(mixed > 100);
    mesh_case_end(&c);
}

static void test_options(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 1);
    csg_node_id red =
        csg_build_color(&c.builder, (csg_color){1, 0, 0, 1}, make_sphere(&c, 0.5), NOWHERE);
    mesh_case_compile(&c, red);
    csgm_mesh_options options = mesh_options(20);
    options.normals = options.colors = false;
    mesh_build_closed(&c, &options, "bare");
    assert_null(c.mesh->normals);
    assert_null(c.mesh->colors);
    test_near(c.stats.cell_size, 0.05, 1e-12);
    options.cell_size = 0.04;
    mesh_build_closed(&c, &options, "cell size");
    test_near(c.stats.cell_size, 0.04, 0);
    assert_int_equal(c.stats.cells[0], 25 + 3);
    uint64_t pruned = c.stats.point_evaluations;
    assert_true(c.stats.pruned_outside + c.stats.pruned_inside > 0);
    options.prune = false;
    mesh_build_closed(&c, &options, "all of it");
    assert_true(c.stats.point_evaluations > pruned);
    mesh_case_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_volumes),        cmocka_unit_test(test_vertices),
        cmocka_unit_test(test_sphere_by_hand), cmocka_unit_test(test_scaled_sphere_by_hand),
        cmocka_unit_test(test_fillets),        cmocka_unit_test(test_colors),
        cmocka_unit_test(test_options),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
