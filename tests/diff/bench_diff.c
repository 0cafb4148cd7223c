/* SPDX-License-Identifier: MIT
 * How long comparisons of two meshes of about a million triangles take, and how much memory: balls
 * that share no vertex, far and hardly apart, noise, a pulled vertex, boxes of a few triangles.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/random.h"
#include "diff/shapes.h"

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void compare(const char *name, diff_shape a, diff_shape b)
{
    csgm_context *context;
    csgm_diff *diff;
    csgm_mesh_view left = diff_view(&a), right = diff_view(&b);
    uint64_t peak = 0;
    if (csgm_context_create(NULL, &context) != CSGM_OK)
        exit(1);
    double begin_s = now_s();
    if (csgm_diff_meshes(context, &left, &right, NULL, &diff) != CSGM_OK)
        exit(1);
    double time_s = now_s() - begin_s;
    const csgm_diff_report *r = csgm_diff_get_report(diff);
    csgm_context_memory(context, &peak);
    printf("%-34s %5.2f s %5" PRIu64 " MB  %" PRIu64 " + %" PRIu64
           " triangles: %.9g to %.9g%s, only A %.5g, only B %.5g +- %.2g\n",
           name, time_s, peak >> 20, left.triangle_count, right.triangle_count, r->hausdorff_lower,
           r->hausdorff_upper,
           r->distance[0].is_refined && r->distance[1].is_refined ? "" : " (not refined)",
           r->volume.only_a, r->volume.only_b, r->volume.accuracy);
    fflush(stdout);
    csgm_diff_destroy(diff);
    csgm_context_destroy(context);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

static diff_shape noisy(diff_shape shape, double size)
{
    csg_random random = {7};
    for (uint64_t i = 0; i < 3 * shape.vertex_count; i++)
        shape.positions[i] += (float)csg_random_uniform(&random, -size, size);
    return shape;
}

static diff_shape pulled(diff_shape shape, float by)
{
    shape.positions[3 * (shape.vertex_count - 1) + 2] += by;
    return shape;
}

int main(int argc, char **argv)
{
    uint32_t n = argc > 1 ? (uint32_t)atoi(argv[1]) : 708;
    const csgm_vec3 o = {0, 0, 0}, off = {0.3, 0.1, 0.2}, one = {1, 1, 1}, less = {0.9, 1, 1};
    compare("concentric balls, 1 % apart", diff_ball(n, n, 10, o),
            diff_ball(n + 1, n - 1, 10.1, o));
    compare("concentric balls, 0.01 % apart", diff_ball(n, n, 10, o),
            diff_ball(n + 1, n - 1, 10.001, o));
    compare("the same ball, other triangles", diff_ball(n, n, 10, o),
            diff_ball(n + 37, n - 35, 10, o));
    compare("the same ball, other order", diff_ball(n, n, 10, o), diff_ball(n, n, 10, o));
    compare("ball, one vertex pulled", diff_ball(n, n, 10, o), pulled(diff_ball(n, n, 10, o), 1));
    compare("ball moved by 0.37", diff_ball(n, n, 10, o), diff_ball(n + 1, n - 1, 10, off));
    compare("ball with noise of 1e-4", diff_ball(n, n, 10, o), noisy(diff_ball(n, n, 10, o), 1e-4));
    compare("fine box, coarse box", diff_box(o, one, 2 * n / 5), diff_box(o, less, 1));
    compare("fine box, the same box coarse", diff_box(o, one, 2 * n / 5), diff_box(o, one, 3));
    diff_shape shuffled = diff_ball(n + 1, n - 1, 10.001, o);
    diff_shape_shuffle(&shuffled, 1);
    compare("0.01 % apart, shuffled", diff_ball(n, n, 10, o), shuffled);
    return 0;
}
