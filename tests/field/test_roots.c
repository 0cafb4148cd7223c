/* SPDX-License-Identifier: MIT
 * Roots along edges: beside kinks, with slopes of very different size, on every instruction set the
 * same bits, and the same whatever else is in the batch.
 */
#include <math.h>
#include <string.h>

#include "field/kernels/roots.h"
#include "field_support.h"

/* Two planes whose values along x have these slopes and meet in a kink; the root lies before it. */
static csg_node_id kinked(csg_scene_builder *builder, double slow, double steep, double at)
{
    csg_span nowhere = {UINT32_MAX, 0, 0};
    double rise = sqrt(1 - slow * slow), fall = sqrt(1 - steep * steep);
    /* slow falls to 0 at x = 1, just beyond the edge's end; steep rises through 0 at `at` */
    csg_vec3 a = csg_vec3_make(slow, rise, 0), b = csg_vec3_make(-steep, fall, 0);
    csg_node_id children[2] = {csg_build_half_space(builder, a, slow, nowhere),
                               csg_build_half_space(builder, b, -steep * at, nowhere)};
    return csg_build_operator(builder, CSG_NODE_INTERSECTION, (csg_blend){0}, children, 2, nowhere);
}

static void add_edge(csg_edges *e, float x, float length)
{
    uint32_t i = e->count++;
    e->ax[i] = x, e->ay[i] = 0, e->az[i] = 0;
    e->dx[i] = length, e->dy[i] = 0, e->dz[i] = 0;
}

static void check_kink(const csg_kernel *kernel, double slow, double steep, double at)
{
    static csg_edges edges;
    float scratch[4096];
    test_subject s;
    test_subject_begin(&s);
    test_subject_compile(&s, kinked(&s.builder, slow, steep, at));
    edges.count = 0;
    add_edge(&edges, 0, 0.9995f);
    kernel->roots(&s.field->tape, &edges, 1e-7f, scratch, 4096);
    double x = (double)edges.x[0];
    double value = fmin(slow * (1 - x), steep * (x - at));
    assert_true(fabs(value) < 0x1p-13 * steep * at + 1e-6);
    test_subject_end(&s);
}

static void test_kinks(void **state)
{
    const csg_kernel *kernels[8];
    size_t count = test_kernels(kernels);
    (void)state;
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < 6; i++)
            for (int j = 1; j < 10; j++)
                check_kink(kernels[k], pow(10, -i), 0.99, 0.1 * j);
}

/* What the field is at both ends of the first edge. */
static void find_ends(const csg_kernel *kernel, const csg_tape *tape, csg_edges *e)
{
    float x[CSG_LANES], f[CSG_LANES], zero[CSG_LANES] = {0}, scratch[4096];
    for (int i = 0; i < CSG_LANES; i++)
        x[i] = i % 2 ? e->ax[0] + e->dx[0] : e->ax[0];
    kernel->values(tape, x, zero, zero, CSG_LANES, f, scratch, 4096);
    e->fa[0] = f[0];
    e->fb[0] = f[1];
}

/* A ball's edges alone and among others, with their ends given or not, on all instruction sets. */
static void test_same_everywhere(void **state)
{
    enum { COUNT = 50 };
    static csg_edges together, alone;
    float scratch[4096];
    const csg_kernel *kernels[8];
    size_t count = test_kernels(kernels);
    csg_random random = {7};
    test_subject s;
    (void)state;
    test_subject_begin(&s);
    test_subject_compile(&s, test_random_scene(&s.builder, &random, 20));
    together.count = 0;
    for (int i = 0; i < COUNT; i++)
        add_edge(&together, (float)csg_random_uniform(&random, -2, 2), 0.25f);
    kernels[0]->roots(&s.field->tape, &together, 1e-7f, scratch, 4096);
    for (uint32_t i = 0; i < COUNT; i++)
        for (size_t k = 0; k < count; k++) {
            alone.count = 0;
            add_edge(&alone, together.ax[i], 0.25f);
            kernels[k]->roots(&s.field->tape, &alone, 1e-7f, scratch, 4096);
            assert_memory_equal(&alone.x[0], &together.x[i], sizeof(float));
            alone.has_ends = true; /* those that values finds */
            find_ends(kernels[k], &s.field->tape, &alone);
            uint64_t asked = kernels[k]->roots(&s.field->tape, &alone, 1e-7f, scratch, 4096);
            alone.has_ends = false;
            assert_memory_equal(&alone.x[0], &together.x[i], sizeof(float));
            assert_int_equal(kernels[k]->roots(&s.field->tape, &alone, 1e-7f, scratch, 4096),
                             asked + 2);
        }
    test_subject_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kinks),
        cmocka_unit_test(test_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
