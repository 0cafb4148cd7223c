/* SPDX-License-Identifier: MIT
 * Formulas of half spaces hold what they promise: in random cubes of random scenes, points that the
 * lower planes have inside are inside by the reference, those that the upper planes have outside
 * are outside. Gradients stray no farther than is promised. Carved cubes have the volumes that cut
 * ones have, by inclusion and exclusion, and sections the areas that these grow by.
 */
#include <stdlib.h>

#include "field/point.h"
#include "measure/carve.h"
#include "measure/section.h"
#include "mesh/mesh_support.h"
#include "scene/primitives/kinds.h"
#include "scene/random_formula.h"

enum { CUBES = 120, POINTS = 60 };

static double plane_at(const csg_enclosure *e, double moved, csg_vec3 d)
{
    return e->value + moved + e->slope[0] * d.x + e->slope[1] * d.y + e->slope[2] * d.z;
}

static csg_truth holds(const csg_halves *h, csg_carve_side side, csg_vec3 d)
{
    csg_truth planes[CSG_HALVES_MOST];
    for (int i = 0; i < h->plane_count; i++) {
        const csg_enclosure *e = &h->planes[i];
        double moved = side == CSG_CARVE_MOST ? e->above : -e->below;
        planes[i] = plane_at(e, moved, d) >= 0 ? CSG_TRUTH_YES : CSG_TRUTH_NO;
    }
    return csg_halves_evaluate(h, planes);
}

typedef struct tally {
    uint32_t known, many, inside, outside, strays, rooms;
} tally;

/* Fillets turn on their operands' gradients: where these jump the reference and floats may be on
 * different sides of the jump, and either will do. */
static bool has_fillets;

/* Of a piece that is the surface alone, at places on the surface: towards d, and back onto it. */
static void try_strays(const mesh_case *m, csg_random *random, const double c[3], double half,
                       float *scratch, size_t floats, tally *seen)
{
    static const double ROUNDING = 2e-4; /* of gradients, by floats and where the place is found */
    csg_halves h;
    if (!csg_halves_find_with_strays(csg_kernel_for(CSGM_ISA_AUTO), &m->field->tape, c, half,
                                     scratch, floats, &h) ||
        h.length != 1 || !(h.planes[0].stray > 0))
        return;
    const csg_enclosure *e = &h.planes[0];
    csg_vec3 slope = csg_vec3_make(e->slope[0], e->slope[1], e->slope[2]);
    csg_vec3 middle = csg_vec3_add(m->field->center, csg_vec3_make(c[0], c[1], c[2]));
    for (int i = 0; i < POINTS / 4; i++) {
        csg_vec3 d = csg_vec3_make(csg_random_uniform(random, -half, half),
                                   csg_random_uniform(random, -half, half),
                                   csg_random_uniform(random, -half, half));
        csg_vec3 on = test_towards_surface(m->scene, csg_vec3_add(middle, d), 6);
        csg_sample s = test_sample(m->scene, on);
        d = csg_vec3_sub(on, middle);
        bool is_there = fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))) <= half;
        if (!is_there || !(fabs(s.value) < 1e-7))
            continue;
        /* On an edge, to the last digit, the reference's gradient is rounding alone. */
        csg_vec3 in = csg_vec3_add(d, csg_vec3_scale(slope, 1e-6));
        csg_vec3 there = test_sample(m->scene, csg_vec3_add(middle, in)).gradient;
        if (csg_vec3_norm(csg_vec3_sub(there, s.gradient)) > 0.1)
            continue;
        double strays = csg_vec3_norm(csg_vec3_sub(s.gradient, slope));
        if (strays > e->stray + ROUNDING)
            fail_msg("a gradient strays by %g, %g is promised, in a cube of half %g", strays,
                     e->stray, half);
        seen->strays++;
    }
}

/* Just beyond a single plane's rooms the solid is inside, or outside, for certain: rooms that leave
 * out some rounding would be found here. */
static void try_rooms(const mesh_case *m, csg_random *random, const double c[3], double half,
                      float *scratch, size_t floats, tally *seen)
{
    static const double BEYOND = 1e-12;
    csg_halves h;
    if (!csg_halves_find(csg_kernel_for(CSGM_ISA_AUTO), &m->field->tape, c, half, scratch, floats,
                         &h) ||
        h.length != 1)
        return;
    const csg_enclosure *e = &h.planes[0];
    csg_vec3 slope = csg_vec3_make(e->slope[0], e->slope[1], e->slope[2]);
    double square = csg_vec3_dot(slope, slope);
    for (int i = 0; i < POINTS / 4 && square > 0.01; i++) {
        csg_vec3 d = csg_vec3_make(csg_random_uniform(random, -half, half),
                                   csg_random_uniform(random, -half, half),
                                   csg_random_uniform(random, -half, half));
        bool in = i & 1;
        double wanted = in ? e->below + BEYOND : -e->above - BEYOND;
        d = csg_vec3_add(d, csg_vec3_scale(slope, (wanted - plane_at(e, 0, d)) / square));
        if (fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))) > half)
            continue;
        csg_vec3 p =
            csg_vec3_add(m->field->center, csg_vec3_make(c[0] + d.x, c[1] + d.y, c[2] + d.z));
        double f = test_sample(m->scene, p).value;
        if (in ? f < 0 : f > 0)
            fail_msg("f = %g beyond rooms of %g and %g, in a cube of half %g", f, e->below,
                     e->above, half);
        seen->rooms++;
    }
}

/* c: field frame. */
static void try_cube(const mesh_case *m, csg_random *random, const double c[3], double half,
                     float *scratch, size_t floats, tally *seen)
{
    static const double ROUNDING = 3e-6; /* of the reference against floats */
    csg_halves h;
    if (!csg_halves_find(csg_kernel_for(CSGM_ISA_AUTO), &m->field->tape, c, half, scratch, floats,
                         &h))
        return;
    seen->known++;
    seen->many += h.plane_count > 1;
    csg_truth state = csg_halves_state(&h, half);
    for (int i = 0; i < POINTS; i++) {
        double d[3];
        for (int k = 0; k < 3; k++) { /* a third of them on faces, edges and corners */
            double u = csg_random_uniform(random, -1.2, 1.2);
            d[k] = half * fmin(fmax(u, -1), 1);
        }
        csg_vec3 at = csg_vec3_make(d[0], d[1], d[2]);
        csg_vec3 p =
            csg_vec3_add(m->field->center, csg_vec3_make(c[0] + d[0], c[1] + d[1], c[2] + d[2]));
        double f = test_sample(m->scene, p).value;
        double other = csg_tape_value_at(csg_kernel_for(CSGM_ISA_AUTO), &m->field->tape,
                                         csg_vec3_sub(p, m->field->center), scratch, floats);
        bool sure = state == CSG_TRUTH_YES || holds(&h, CSG_CARVE_LEAST, at) == CSG_TRUTH_YES;
        bool never = state == CSG_TRUTH_NO || holds(&h, CSG_CARVE_MOST, at) == CSG_TRUTH_NO;
        if (has_fillets && fabs(f - other) > ROUNDING)
            f = sure ? fmax(f, other) : fmin(f, other);
        if ((sure && f < -ROUNDING) || (never && f > ROUNDING))
            fail_msg("f = %g at (%.9g, %.9g, %.9g), called %s, in a cube of half %g", f, p.x, p.y,
                     p.z, sure ? "inside" : "outside", half);
        seen->inside += sure;
        seen->outside += never;
    }
}

/* Cubes near the surface, centres and halves exact as floats. */
static void try_scene(const mesh_case *m, csg_random *random, tally *seen)
{
    size_t floats = csg_kernel_scratch_floats(m->field->depth);
    float *scratch = malloc(floats * sizeof *scratch);
    assert_non_null(scratch);
    csg_box b = m->field->bounds;
    csg_vec3 size = csg_box_size(b);
    if (csg_box_is_finite(b) && !csg_box_is_empty(b))
        for (int i = 0; i < CUBES; i++) {
            double half = ldexp(1, -2 - (int)csg_random_below(random, 7)), c[3];
            csg_vec3 p;
            double f = INFINITY;
            for (int k = 0; k < 20 && fabs(f) > half; k++) {
                p = csg_vec3_make(csg_random_uniform(random, b.min.x, b.min.x + size.x),
                                  csg_random_uniform(random, b.min.y, b.min.y + size.y),
                                  csg_random_uniform(random, b.min.z, b.min.z + size.z));
                p = test_towards_surface(m->scene, p, 1);
                f = test_sample(m->scene, p).value;
            }
            p = csg_vec3_sub(p, m->field->center);
            c[0] = half * round(p.x / half);
            c[1] = half * round(p.y / half);
            c[2] = half * round(p.z / half);
            try_cube(m, random, c, half, scratch, floats, seen);
            if (!has_fillets) {
                try_strays(m, random, c, half, scratch, floats, seen);
                try_rooms(m, random, c, half, scratch, floats, seen);
            }
        }
    free(scratch);
}

static void halves_hold(void **state)
{
    tally seen = {0};
    for (uint64_t i = 0; i < ROUNDS(60) * test_times; i++) {
        csg_random random = {.state = 7000 + test_first_seed + i};
        mesh_case m;
        mesh_case_begin(&m, 1);
        csg_node_id root = test_random_mixed(&m.builder, &random, i);
        has_fillets = test_random_fillets;
        assert_true(root != CSG_NODE_NONE);
        mesh_case_compile(&m, root);
        if (!test_has_debulge(m.scene))
            try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.known > ROUNDS(2000) * test_times && seen.many > ROUNDS(200) * test_times);
    assert_true(seen.inside > ROUNDS(20000) * test_times &&
                seen.outside > ROUNDS(20000) * test_times);
    assert_true(seen.strays > ROUNDS(5000) * test_times && seen.rooms > ROUNDS(5000) * test_times);
}

/* Boxes, cylinders and cones by their edges, flat ones too, joined sharply. */
static void creases_hold(void **state)
{
    tally seen = {0};
    has_fillets = false;
    for (uint64_t i = 0; i < ROUNDS(60) * test_times; i++) {
        csg_random random = {.state = 9000 + test_first_seed + i};
        mesh_case m;
        mesh_case_begin(&m, 1);
        csg_node_id ids[2];
        for (int k = 0; k < 2; k++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS] = {0};
            bool is_box = csg_random_below(&random, 2);
            for (int n = 0; n < 3; n++)
                v[n] = csg_random_uniform(&random, is_box ? 0.2 : 0, 1);
            if (!is_box)
                v[2] *= csg_random_below(&random, 3) ? 1 : 0.1;
            v[2] += 0.01;
            ids[k] = posed_anyhow(&m,
                                  csg_build_primitive(&m.builder,
                                                      is_box ? (csg_primitive_kind)CSG_NODE_BOX
                                                             : (csg_primitive_kind)CSG_NODE_FRUSTUM,
                                                      v, NOWHERE),
                                  &random);
        }
        csg_node_kind kinds[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE, CSG_NODE_INTERSECTION};
        mesh_case_compile(&m, joined(&m, kinds[i % 3], SHARP, ids[0], ids[1]));
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.many > ROUNDS(2000) * test_times && seen.rooms > ROUNDS(5000) * test_times);
}

/* In cubes whose centre is on a capsule's axis, where its gradient is a direction of rounding
 * errors.
 */
static void capsules_hold_on_their_axes(void **state)
{
    tally seen = {0};
    has_fillets = false;
    for (uint64_t i = 0; i < ROUNDS(60) * test_times; i++) {
        csg_random random = {.state = 15000 + test_first_seed + i};
        mesh_case m;
        mesh_case_begin(&m, 1);
        double r = csg_random_uniform(&random, 0.2, 1);
        const double v[] = {csg_random_uniform(&random, 1, 3), r, r};
        csg_node_id id =
            csg_build_primitive(&m.builder, (csg_primitive_kind)CSG_NODE_CAPSULE, v, NOWHERE);
        mesh_case_compile(&m, posed_anyhow(&m, id, &random));
        size_t floats = csg_kernel_scratch_floats(m.field->depth);
        float *scratch = malloc(floats * sizeof *scratch);
        assert_non_null(scratch);
        for (int k = 0; k < 24; k++) { /* 0 is the middle of its box */
            float c[3];
            for (int axis = 0; axis < 3; axis++)
                c[axis] = k ? (float)ldexp(csg_random_uniform(&random, -1, 1), -k) : 0;
            const double at[3] = {(double)c[0], (double)c[1], (double)c[2]};
            try_cube(&m, &random, at, ldexp(1, k % 5 - 2), scratch, floats, &seen);
        }
        free(scratch);
        mesh_case_end(&m);
    }
    assert_true(seen.inside > ROUNDS(2000) * test_times);
}

/* ---- formulas ----------------------------------------------------------------------------------
 */

static csg_vec3 any_in_cube(csg_random *random, double half)
{
    return csg_vec3_make(csg_random_uniform(random, -half, half),
                         csg_random_uniform(random, -half, half),
                         csg_random_uniform(random, -half, half));
}

/* The field between its planes, gradients within the stray, and no two of them farther from each
 * other than the bend allows. */
static void check_bend(const mesh_case *m, csg_random *random, const double c[3], double half,
                       const csg_enclosure *e)
{
    csg_vec3 center = csg_vec3_add(m->field->center, csg_vec3_make(c[0], c[1], c[2]));
    const csg_vec3 slope = csg_vec3_make(e->slope[0], e->slope[1], e->slope[2]);
    for (int i = 0; i < POINTS / 2; i++) {
        csg_vec3 p = any_in_cube(random, half), q = any_in_cube(random, half);
        csg_sample f = test_sample(m->scene, csg_vec3_add(center, p));
        csg_sample g = test_sample(m->scene, csg_vec3_add(center, q));
        double off = f.value - e->value - csg_vec3_dot(slope, p), rounding = 2e-6;
        double length = csg_vec3_norm(csg_vec3_sub(p, q));
        double turn = csg_vec3_norm(csg_vec3_sub(f.gradient, g.gradient));
        double stray = csg_vec3_norm(csg_vec3_sub(f.gradient, slope));
        if (!(off <= e->above + rounding && off >= -e->below - rounding))
            fail_msg("off by %g, not by %g or %g at most", off, e->above, e->below);
        if (!(turn <= e->bend * length * (1 + 1e-6) + 1e-7 && stray <= e->stray + 1e-7))
            fail_msg("turns by %g over %g and strays by %g, not by %g a length and %g", turn,
                     length, stray, e->bend, e->stray);
    }
}

static void formulas_bend(void **state)
{
    uint32_t known = 0;
    for (uint64_t i = 0; i < ROUNDS(200) * test_times; i++) {
        csg_random random = {.state = 21000 + test_first_seed + i};
        csg_formula_step steps[TEST_MOST_STEPS];
        const csg_field_domain domain = {{{-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8}}, false, 100, true};
        mesh_case m;
        mesh_case_begin(&m, 1);
        uint32_t count =
            test_random_formula(&m.context.memory, &random, 1 + (unsigned)(i % 5), true, steps);
        csg_node_id id = csg_build_field(&m.builder, steps, count, &domain, NOWHERE);
        mesh_case_compile(&m, posed_anyhow(&m, id, &random));
        size_t floats = csg_kernel_scratch_floats(m.field->depth);
        float *scratch = malloc(floats * sizeof *scratch);
        assert_non_null(scratch);
        for (int k = 0; k < 30; k++) {
            double half = ldexp(1, -3 - k % 6), c[3];
            csg_enclosure e = {.is_convex = true}; /* nobody may rely on what was there */
            for (int axis = 0; axis < 3; axis++)
                c[axis] = half * round(csg_random_uniform(&random, -0.5, 0.5) / half);
            if (!csg_enclosure_find(csg_kernel_for(CSGM_ISA_AUTO), &m.field->tape, c, half, scratch,
                                    floats, &e) ||
                !(e.bend > 0))
                continue;
            check_bend(&m, &random, c, half, &e);
            assert_false(e.is_convex);
            known++;
        }
        free(scratch);
        mesh_case_end(&m);
    }
    assert_true(known > ROUNDS(300) * test_times);
}

static void add_plane(csg_halves *h, csg_random *random)
{
    csg_enclosure *e = &h->planes[h->plane_count];
    e->value = csg_random_uniform(random, -0.8, 0.8);
    for (int k = 0; k < 3; k++)
        e->slope[k] = csg_random_uniform(random, -1, 1);
    e->below = e->above = 0;
    h->code[h->length++] = (signed char)h->plane_count++;
}

static void carved_as_cut(void **state)
{
    csg_random random = {.state = 23};
    for (int i = 0; i < 2000; i++) {
        csg_halves both = {.length = 0}, one[2];
        double half = exp(csg_random_uniform(&random, -8, 3)), volume[4];
        double integrals[4][CSG_INTEGRALS];
        add_plane(&both, &random);
        add_plane(&both, &random);
        for (int k = 0; k < 2; k++) {
            both.planes[k].value *= half;
            one[k] = (csg_halves){.plane_count = 1, .length = 1};
            one[k].planes[0] = both.planes[k];
            volume[k] = csg_carve(&one[k], half, CSG_CARVE_LEAST, integrals[k]);
        }
        both.length = 3;
        both.code[2] = CSG_HALVES_UNION;
        volume[2] = csg_carve(&both, half, CSG_CARVE_LEAST, integrals[2]);
        both.code[2] = CSG_HALVES_INTERSECTION;
        volume[3] = csg_carve(&both, half, CSG_CARVE_MOST, integrals[3]);
        double whole = 8 * half * half * half, room = CSG_CUT_ROUNDING * whole;
        assert_true(fabs(volume[0] + volume[1] - volume[2] - volume[3]) <= room);
        assert_true(volume[2] >= fmax(volume[0], volume[1]) - room);
        for (int n = 0; n < CSG_INTEGRALS; n++) {
            double size = n == 0 ? 1 : n < CSG_INTEGRAL_XX ? half : half * half;
            double off = integrals[0][n] + integrals[1][n] - integrals[2][n] - integrals[3][n];
            assert_true(fabs(off) <= room * size);
        }
    }
}

/* A formula of planes at random, of which some are nearly one. */
static void make_formula(csg_halves *h, csg_random *random)
{
    int planes = 1 + (int)csg_random_below(random, 4);
    *h = (csg_halves){.length = 0};
    for (int i = 0; i < planes; i++) {
        csg_enclosure *e = &h->planes[i];
        add_plane(h, random);
        if (i && !csg_random_below(random, 3)) {
            *e = h->planes[0];
            e->value += csg_random_uniform(random, -1e-3, 1e-3);
        }
        e->below = csg_random_uniform(random, 0, 0.02);
        e->above = csg_random_uniform(random, 0, 0.02);
        bool joins = csg_random_below(random, 2);
        if (i)
            h->code[h->length++] = joins ? CSG_HALVES_UNION : CSG_HALVES_INTERSECTION;
    }
}

static bool is_solid(const csg_halves *h, const double *moved, csg_vec3 d)
{
    csg_truth planes[CSG_HALVES_MOST];
    for (int i = 0; i < h->plane_count; i++)
        planes[i] = plane_at(&h->planes[i], moved[i], d) >= 0 ? CSG_TRUTH_YES : CSG_TRUTH_NO;
    return csg_halves_evaluate(h, planes) == CSG_TRUTH_YES;
}

/* How fast the carved volume grows where all planes move outwards by as much. */
static double area_by_growth(const csg_halves *h, const double *moved, double half)
{
    const double step = 1e-6;
    double volumes[2];
    for (int side = 0; side < 2; side++) {
        csg_halves grown = *h;
        for (int i = 0; i < h->plane_count; i++) {
            csg_enclosure *e = &grown.planes[i];
            const double *s = e->slope;
            e->value +=
                moved[i] + (side ? 1 : -1) * step * sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
            e->below = e->above = 0;
        }
        volumes[side] = csg_carve(&grown, half, CSG_CARVE_MOST, NULL);
    }
    return (volumes[1] - volumes[0]) / (2 * step);
}

/* Wherever in their rooms the planes are, faces and surfaces have areas that sections allow. */
static void sections_hold(void **state)
{
    enum { GRID = 60 };
    const double half = 0.7;
    int certain = 0;
    for (uint64_t i = 0; i < ROUNDS(150) * test_times; i++) {
        csg_random random = {.state = 21000 + test_first_seed + i};
        csg_halves h;
        double moved[CSG_HALVES_MOST];
        make_formula(&h, &random);
        for (int k = 0; k < h.plane_count; k++)
            moved[k] = csg_random_uniform(&random, -h.planes[k].below, h.planes[k].above);
        for (int face = 0; face < 6; face++) {
            int axis = face / 2, side = face & 1 ? 1 : -1, count = 0;
            csg_section found = csg_section_of_face(&h, half, axis, side);
            for (int u = 0; u < GRID; u++)
                for (int v = 0; v < GRID; v++) {
                    double d[3];
                    d[axis] = side * half;
                    d[(axis + 1) % 3] = half * ((u + 0.5) * 2 / GRID - 1);
                    d[(axis + 2) % 3] = half * ((v + 0.5) * 2 / GRID - 1);
                    count += is_solid(&h, moved, csg_vec3_make(d[0], d[1], d[2]));
                }
            double area = count * 4 * half * half / (GRID * GRID), room = 8 * half * half / GRID;
            assert_true(found.least <= area + room && found.most >= area - room);
            assert_true(found.most <= 4 * half * half);
        }
        csg_section_group groups[CSG_HALVES_MOST];
        int count = csg_section_find_groups(&h, half, groups);
        double least = 0, most = 0, area = area_by_growth(&h, moved, half);
        for (int n = 0; n < count; n++) {
            csg_section found = csg_section_of_group(&h, half, &groups[n]);
            least += found.least;
            most += found.most;
        }
        if (least > area + 1e-3 || most < area - 1e-3)
            fail_msg("an area of %g, but %g .. %g is promised", area, least, most);
        certain += least > 0;
    }
    assert_true(certain > ROUNDS(50));
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(halves_hold),
        cmocka_unit_test(creases_hold),
        cmocka_unit_test(capsules_hold_on_their_axes),
        cmocka_unit_test(formulas_bend),
        cmocka_unit_test(carved_as_cut),
        cmocka_unit_test(sections_hold),
    };
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
